// How the members of a class differ, for what a fragment does not show: a mean shape and modes of variation.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/reconstruction/fit.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// Shapes with the template's vertices: mean + sum of b_k times mode k, the b_k with these standard deviations. In any position
/// and unit.
struct ShapePrior {
    std::vector<Eigen::Vector3d> mean;  ///< of each vertex
    Eigen::MatrixXd modes;              ///< a column a mode: x, y, z of the first vertex, then of the second ...
    std::vector<double> deviations;     ///< of each mode's coefficient

    /// Throws Error (input) unless it has these many vertices and all sizes agree.
    void check(std::size_t vertices) const;
};

struct PriorOptions {
    int iterations = 40;
    double maximum = 3;          ///< standard deviations that a coefficient may go
    double samples = 20;         ///< least number of independent places that the observed surface counts as, against the prior
    double search_radius = 0.1;  ///< farthest match, as a share of the diagonal
    double angle = 60;           ///< of the normals of matches, degrees

    void describe(OptionList& visit);
};

struct PriorFit {
    Mesh mesh;                         ///< the template in the shape that the class would give it, where the scaled template is
    std::vector<double> coefficients;  ///< in standard deviations
    double residual = 0;               ///< root mean square distance of matched vertices from the fragments' planes
    double samples = 0;                ///< independent places that the matched surface counted as, by how its residuals vary
    std::size_t matched = 0;
    int iterations = 0;
};

/// The most probable shape of the class for what is observed (maximum a posteriori; cf. statistical shape models, Cootes et al.
/// 1995, Blanz and Vetter 1999): by turns, the nearest places of the class's shape to places
/// spread over the fragments (about 3000, like among like as in `fit_template`), and a linear least squares problem for a
/// rotation, translation and scale of the shape and the coefficients, point to plane with Tukey's biweight, with the landmarks
/// and the coefficients' Mahalanobis distance, against which the residuals count as the independent places that they show. Starts
/// at the mean registered to `scaled`. Throws Error as ShapePrior::check.
PriorFit fit_prior(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                   const ShapePrior& prior, const PriorOptions& options = {});

}  // namespace ostraka
