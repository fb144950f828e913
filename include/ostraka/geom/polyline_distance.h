// Distances between curves given as segments.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

using Segments = std::vector<std::pair<Point, Point>>;

/// Two-sided Hausdorff distance between two sets of segments (degenerate segments represent points), sampled at the end points
/// and midpoints of each set and exact for these samples (AABB tree, O(n log n)). 0 if both are empty, infinite if one is.
double hausdorff_distance(const Segments& a, const Segments& b);

}  // namespace ostraka
