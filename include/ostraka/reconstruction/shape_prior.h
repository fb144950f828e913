// Statistical shape model of a class (a mean shape and modes of variation), used to estimate the unobserved part of an object.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// A linear model of the positions of the template's vertices: mean + sum over k of b_k times mode k. The coefficients b_k have
/// the given standard deviations. Pose and unit of the model are arbitrary.
struct ShapePrior {
    std::vector<Eigen::Vector3d> mean;  ///< mean position of each vertex
    Eigen::MatrixXd modes;              ///< one column per mode; rows: x, y, z of the first vertex, then of the second ...
    std::vector<double> deviations;     ///< standard deviation of each mode's coefficient

    /// Throws Error (input) unless the model has this number of vertices and the sizes of all members agree.
    void check(std::size_t vertices) const;
};

struct PriorOptions {
    int iterations = 40;  ///< max number of iterations
    double maximum = 3;   ///< max absolute value of a mode's coefficient, in its standard deviations
    /// The weight of the observed surface relative to the prior is the number of its independent samples, but at least this
    /// number.
    double samples = 20;
    double search_radius = 0.1;  ///< max distance of a match, as a share of the template's diagonal
    double angle = 60;           ///< max angle between the normals of a match, degrees

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Result of `fit_prior`: the most probable shape of the class, given the fragments.
struct PriorFit {
    Mesh mesh;                         ///< the template in the estimated shape, in the frame of the scaled template
    std::vector<double> coefficients;  ///< coefficients of the modes, in standard deviations
    double residual = 0;               ///< root mean square distance of matched points from the planes of their matches
    double samples = 0;       ///< effective number of independent samples of the matched surface, estimated from the residuals
    std::size_t matched = 0;  ///< number of matched points
    int iterations = 0;       ///< number of iterations
};

/// Computes the maximum a posteriori shape of the class, given the observed part (cf. statistical shape models, Cootes et al.
/// 1995, Blanz and Vetter 1999). Alternates between two steps: finding the nearest points of the class's shape to about 3000
/// points spread over the fragments (within matched annotations, as `fit_template`), and a linear least squares problem for the
/// coefficients and a rotation, translation and scale of the shape. The problem has point-to-plane residuals with Tukey's
/// biweight, the landmarks, and the Mahalanobis distance of the coefficients, against which the residuals are weighted by their
/// number of independent samples. Starts at the mean shape registered to `scaled`, the template at the scale of the placement.
/// Throws the same errors as ShapePrior::check.
PriorFit fit_prior(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments, const ShapePrior& prior,
                   const PriorOptions& options = {});

}  // namespace ostraka
