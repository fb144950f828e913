// Which contours contain which.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// Sets parent and depth of the closed contours, which stand in front, sorted by falling absolute area. Exact for the points as
/// given, also where contours touch. O(n log n) for contours of even size: a horizontal line through a point is compared with the
/// edges of one thin strip only.
void nest(std::vector<Contour>& contours);

}  // namespace ostraka::detail
