// How much of its outline a slice has.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// All but `doubtful`.
Completeness completeness(const std::vector<Contour>& contours);

/// What the contours cover of the full turn around `centre`, in radians.
double angle_covered(const std::vector<Contour>& contours, const Eigen::Vector2d& centre);

}  // namespace ostraka::detail
