// What is done with the contours of slices once they are joined.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// Sorts and nests the contours of each slice, finds those that cross, turns those around whose orientation is not that of their
/// nesting, and says how complete each slice is. `whole`: no part of the mesh was left out. Returns whether all contours were
/// turned around because the mesh is closed and inside out. O(n log n) but for a sorting of the edges whose boxes overlap; in
/// parallel.
bool settle(std::vector<Slice>& slices, const Mesh& mesh, bool whole);

/// Throws Error (input) for a mesh without faces, Error (usage) for a face that is not in it.
void check_faces(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka::detail
