// Rows of weights projected to be valid: non-negative, with sum one, reproducing the point.
#pragma once

#include "coords/cage_interior.h"

#include "ostraka/coords/coordinates.h"

#include <functional>
#include <span>

namespace ostraka::coords {

/// Replaces `weights` by the nearest weights (least squares) that are non-negative, sum to one and whose combination of
/// `corners` is `place`, by Newton's method on the dual with four unknowns. Returns false and leaves the weights unchanged if
/// none are found: the place is outside the convex hull of the corners, or almost on its boundary.
bool project_row(std::span<double> weights, std::span<const Eigen::Vector3d> corners, const Eigen::Vector3d& place);

/// Coordinates with valid rows. Points on the cage get linear weights. For the others `estimate` fills a row that is zero at
/// first; it is called from several threads. `prepare` is called once before, if there is such a point. Weights below `drop`
/// are dropped and the rest projected, so that every row stays valid. Throws Error (input) that lists points outside the cage.
Coordinates bounded_coordinates(const UnitCage& cage, const std::vector<Point>& points, double snap, double drop,
                                const std::string& kind, const std::function<void()>& prepare,
                                const std::function<void(const Eigen::Vector3d& place, std::span<double> row)>& estimate);

}  // namespace ostraka::coords
