// Segments joined to poly-lines.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace ostraka {

/// Segments between numbered ends, joined where two and only two meet; each list gives the ends of a poly-line in turn, a closed
/// one its first again at the end. Poly-lines that begin at an end or a branching come first, in the order of the segments. O(n).
std::vector<std::vector<std::size_t>> chains_of(const std::vector<std::array<std::size_t, 2>>& segments);

}  // namespace ostraka
