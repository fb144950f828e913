// Distances between curves that are given as lists of segments.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

using Segments = std::vector<std::pair<Point, Point>>;  ///< the two ends of each segment

/// Two-sided Hausdorff distance between two sets of segments (degenerate segments represent points), sampled at the end points
/// and midpoints of the segments; the distances of the samples are exact (AABB tree, O(n log n)). The distance is 0 if both sets
/// are empty, and infinite if only one set is empty.
double hausdorff_distance(const Segments& a, const Segments& b);

}  // namespace ostraka
