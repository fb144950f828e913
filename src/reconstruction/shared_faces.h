// Detects fragments that have the template's own faces, and identifies their vertices by connectivity.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// For each vertex of `fragment` the corresponding vertex of `mesh`, if the fragment is a piece of `mesh` in another shape (a
/// member of a class derived from its template, an edited copy). `broken` marks faces to ignore (one flag per face; empty: none).
/// Pieces of the fragment are recognised by the degrees of some thirty vertices around an edge, and traversed from there over all
/// their faces; a piece counts only if every one of its faces is a face of `mesh`. If a symmetric `mesh` has several candidate
/// positions, the position nearest to the mesh scaled by `scale` is used. `no_index` for vertices of meshes so regular that no
/// neighbourhood is distinctive, and of pieces that are too small. Time: O(n).
std::vector<Index> shared_vertices(const Mesh& mesh, const Mesh& fragment, double scale = 1,
                                   const std::vector<bool>& broken = {});

}  // namespace ostraka
