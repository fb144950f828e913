// Statistical shape model of a class, for the unobserved part: a mean shape and modes of variation.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// Shapes with the template's vertices: mean + sum of b_k times mode k; the b_k have these standard deviations. In any position
/// and unit.
struct ShapePrior {
    std::vector<Eigen::Vector3d> mean;  ///< per vertex
    Eigen::MatrixXd modes;              ///< one column per mode: x, y, z of the first vertex, then of the second ...
    std::vector<double> deviations;     ///< standard deviation of each mode's coefficient

    /// Throws Error (input) unless the number of vertices matches and all sizes agree.
    void check(std::size_t vertices) const;
};

struct PriorOptions {
    int iterations = 40;
    double maximum = 3;   ///< max absolute coefficient, in standard deviations
    double samples = 20;  ///< minimum number of independent samples as which the observed surface is weighted against the prior
    double search_radius = 0.1;  ///< max distance of a match, as a share of the diagonal
    double angle = 60;           ///< max angle between the normals of a match, degrees

    void describe(OptionList& visit);
};

struct PriorFit {
    Mesh mesh;                         ///< the template in the estimated shape, in the frame of the scaled template
    std::vector<double> coefficients;  ///< in standard deviations
    double residual = 0;               ///< root mean square distance of matched vertices from the fragments' planes
    double samples = 0;                ///< effective number of independent samples of the matched surface, from its residuals
    std::size_t matched = 0;
    int iterations = 0;
};

/// Maximum a posteriori shape of the class for the observed part (cf. statistical shape models, Cootes et al. 1995, Blanz and
/// Vetter 1999). Alternates between finding the nearest points of the class's shape to about 3000 points spread over the
/// fragments (with matched annotations as in `fit_template`), and a linear least squares problem for a rotation, translation
/// and scale of the shape and the coefficients: point to plane with Tukey's biweight, with the landmarks and the coefficients'
/// Mahalanobis distance, against which the residuals are weighted by their number of independent samples. Starts at the mean
/// registered to `scaled`. Throws Error as ShapePrior::check.
PriorFit fit_prior(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments, const ShapePrior& prior,
                   const PriorOptions& options = {});

}  // namespace ostraka
