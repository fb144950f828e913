// Rows of weights that keep what coordinates promise: none below zero, a sum of one, the point itself.
#pragma once

#include "cage_interior.h"

#include "ostraka/coords/coordinates.h"

#include <functional>
#include <span>

namespace ostraka::coords {

/// The weights nearest to `weights` (least squares) that are not negative, sum to one, and whose combination of `corners` is
/// `place`; in place. Newton's method on the dual, four unknowns. False, and the weights as they were, where no such weights are
/// found: the place is not in the corners' convex hull, or all but on its border.
bool project_row(std::span<double> weights, std::span<const Eigen::Vector3d> corners, const Eigen::Vector3d& place);

/// Coordinates of points that lie on the cage: linear. Of the others those that `estimate` gives: a row to fill (all zero);
/// called from several threads, after `prepare`, which is called once if there is such a point. Weights below `drop` are left out
/// and the others projected, so that every row keeps its promises. Throws Error (input) that lists points outside.
Coordinates bounded_coordinates(const UnitCage& cage, const std::vector<Point>& points, double snap, double drop,
                                const std::string& kind, const std::function<void()>& prepare,
                                const std::function<void(const Eigen::Vector3d& place, std::span<double> row)>& estimate);

}  // namespace ostraka::coords
