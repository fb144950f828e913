// How much of its outline a slice has.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// All but `doubtful`.
Completeness completeness(const std::vector<Contour>& contours);

}  // namespace ostraka::detail
