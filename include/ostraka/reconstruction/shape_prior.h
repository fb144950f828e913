// Statistical shape model of a class, from which the unobserved part is estimated: a mean shape and modes of variation.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// Shapes of the template's vertices: mean + sum over k of b_k times mode k, where the coefficients b_k have the given standard
/// deviations. Position and unit of the shapes are arbitrary.
struct ShapePrior {
    std::vector<Eigen::Vector3d> mean;  ///< mean position of each vertex
    Eigen::MatrixXd modes;              ///< one column per mode; rows: x, y, z of the first vertex, then of the second ...
    std::vector<double> deviations;     ///< standard deviation of each mode's coefficient

    /// Throws Error (input) unless the model has this number of vertices and the sizes of all members agree.
    void check(std::size_t vertices) const;
};

struct PriorOptions {
    int iterations = 40;  ///< max number of iterations
    double maximum = 3;   ///< max absolute value of a coefficient, in standard deviations
    double samples = 20;  ///< min number of independent samples with which the observed surface is weighted against the prior
    double search_radius = 0.1;  ///< max distance of a match, as a share of the template's diagonal
    double angle = 60;           ///< max angle between the normals of a match, degrees

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The most probable shape of the class.
struct PriorFit {
    Mesh mesh;                         ///< the template in the estimated shape, in the frame of the scaled template
    std::vector<double> coefficients;  ///< coefficients of the modes, in standard deviations
    double residual = 0;               ///< root mean square distance of matched points from the planes of their matches
    double samples = 0;       ///< effective number of independent samples of the matched surface, estimated from the residuals
    std::size_t matched = 0;  ///< number of matched points
    int iterations = 0;       ///< number of iterations
};

/// Maximum a posteriori shape of the class for the observed part (cf. statistical shape models, Cootes et al. 1995, Blanz and
/// Vetter 1999). Alternates between two steps: finding the nearest points of the class's shape to about 3000 points spread over
/// the fragments (within matched annotations, as `fit_template`), and a linear least squares problem for the coefficients and a
/// rotation, translation and scale of the shape. The problem has point-to-plane residuals with Tukey's biweight, the landmarks,
/// and the Mahalanobis distance of the coefficients, against which the residuals are weighted by their number of independent
/// samples. Starts at the mean shape registered to `scaled`, the template at the scale of the placement. Throws Error as
/// ShapePrior::check.
PriorFit fit_prior(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments, const ShapePrior& prior,
                   const PriorOptions& options = {});

}  // namespace ostraka
