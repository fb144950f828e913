// Where the legs of a closed path over a mesh cross each other.
#pragma once

#include "ostraka/core/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

struct Crossing {
    std::size_t one = 0, other = 0;  ///< legs
    Index vertex = no_index;         ///< where they meet
};

/// The first pair of legs of which one ends up on the other side of the other: legs that only touch, or that run together for a
/// while and part to the side they came from, do not cross, nor do legs that meet at the end of one of them. Each leg is a path
/// of vertices that visits none twice. Linear in the length of all legs, but for pairs that share vertices.
std::optional<Crossing> find_crossing(const Mesh& mesh, const std::vector<std::vector<Index>>& legs);

/// True if two legs share a vertex that is not where one ends and the next begins.
bool touch(const std::vector<std::vector<Index>>& legs);

}  // namespace ostraka
