// Poly-lines from loose edges.
#pragma once

#include "ostraka/core/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

/// Joins edges (pairs of vertices, in any order, each once) into as few vertex paths as simple walking gives: paths begin where
/// the number of edges is not two, the rest are closed (first = last). Deterministic: lowest vertex first. O(n log n).
std::vector<std::vector<Index>> join_into_paths(const std::vector<std::pair<Index, Index>>& edges);

}  // namespace ostraka
