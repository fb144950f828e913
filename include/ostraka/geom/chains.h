// Joins segments to poly-lines.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ostraka {

/// Joins segments (pairs of point indices) to poly-lines, at points where exactly two segments meet. Returns the point indices
/// of each poly-line; a closed poly-line repeats its first point at the end. Poly-lines that begin at a free end or a branching
/// come first, in the order of the segments. Time: O(n).
std::vector<std::vector<std::size_t>> chains_of(const std::vector<std::array<std::size_t, 2>>& segments);

}  // namespace ostraka
