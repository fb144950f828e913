// Distances between curves given by segments.
#pragma once

#include "ostraka/core/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

using Segments = std::vector<std::pair<Point, Point>>;

/// Two-sided Hausdorff distance between two sets of segments (degenerate ones stand for points), measured at the end
/// points and midpoints of each and exact for those (AABB tree, O(n log n)). 0 if both are empty, infinite if one is.
double hausdorff_distance(const Segments& a, const Segments& b);

}  // namespace ostraka
