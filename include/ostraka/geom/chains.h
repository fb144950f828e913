// Joins segments to poly-lines.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ostraka {

/// Segments are given by the indices of their ends and joined where exactly two of them meet. Returns each poly-line as the
/// list of its ends; a closed one repeats its first at the end. Poly-lines that begin at a free end or a branching come first,
/// in the order of the segments. O(n).
std::vector<std::vector<std::size_t>> chains_of(const std::vector<std::array<std::size_t, 2>>& segments);

}  // namespace ostraka
