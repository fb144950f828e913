// Noise of a scanned surface, estimated from the surface itself.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Noise of a surface, one value per vertex; NaN where it cannot be estimated.
struct ScanNoise {
    /// Standard deviation of the vertices around the vertex, along the normal, from a quadric fitted to them.
    std::vector<double> deviation;
    std::vector<double> curvature;  ///< largest absolute principal curvature of the fitted quadric, in 1/length
    double radius = 0;              ///< radius of the fits
    double median = 0;              ///< median of the deviations; NaN if there is none
    /// Correlation of the residuals of vertices joined by an edge: about 0 for independent noise, near 1 if the surface was
    /// smoothed or has relief smaller than the radius. NaN if there are no residuals.
    double correlation = 0;
    std::size_t without = 0;  ///< number of vertices without a value
};

/// Estimates the noise at each vertex: the quadric z = a + bx + cy + dx^2 + exy + fy^2 that fits the n vertices within `radius`
/// that are connected with the vertex within the ball best, over their plane of least squares; the deviation is the root of the
/// squared residuals over n - 6. Relief smaller than the radius counts as noise. A vertex needs at least 9 such vertices.
/// `radius`: 0 for three times the mean edge length. O(n) times the number of vertices in a ball. Throws Error (usage) for a
/// negative radius.
ScanNoise scan_noise(const Mesh& mesh, double radius = 0);

/// What the noise of a mesh contributes to the uncertainty of a distance.
struct PlaceNoise {
    double variance = 0;  ///< variance of the place along the normal; NaN if a corner with weight has no noise
    /// Height of the curved surface over the flat face, from the curvature k and the longest edge l: l^2 k / 6; NaN likewise.
    double facet_height = 0;
};
/// Noise at a place of a face: the noise of the corners is independent, so the variances are weighted by the squares.
PlaceNoise noise_at(const Mesh& mesh, const ScanNoise& noise, Index face, const std::array<double, 3>& weights);

}  // namespace ostraka
