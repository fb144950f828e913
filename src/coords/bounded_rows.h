// Projection of rows of weights to valid rows: non-negative, with sum one, reproducing the point.
#pragma once

#include "coords/cage_interior.h"

#include "ostraka/coords/coordinates.h"

#include <functional>
#include <span>

namespace ostraka::coords {

/// Replaces `weights` by the closest weights (least squares) that are non-negative, sum to one and reproduce `place` as a
/// combination of `corners`, by Newton's method on the dual with four unknowns. Returns false and leaves the weights unchanged if
/// there are no such weights: the place is outside the convex hull of the corners, or almost on its boundary.
bool project_row(std::span<double> weights, std::span<const Eigen::Vector3d> corners, const Eigen::Vector3d& place);

/// Computes coordinates whose rows are all valid. Points on the cage get linear weights. For each other point `estimate` fills a
/// row that is initially zero; `estimate` is called from several threads. Before its first call, `prepare` is called once.
/// Weights below `drop` are dropped and the remaining weights are projected, so that every row is valid. Throws Error (input)
/// that lists points outside the cage.
Coordinates bounded_coordinates(const UnitCage& cage, const std::vector<Point>& points, double snap, double drop,
                                const std::string& kind, const std::function<void()>& prepare,
                                const std::function<void(const Eigen::Vector3d& place, std::span<double> row)>& estimate);

}  // namespace ostraka::coords
