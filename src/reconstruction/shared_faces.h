// Fragments whose faces are the template's: which vertex is which follows from how faces join.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// For each vertex of `fragment` the vertex of `mesh` that it is, where the fragment is a piece of that mesh in another shape (a
/// member of a class made from its template, a copy that was edited). `broken` marks faces that are no part of it (of each face;
/// empty: none). Pieces of the fragment are recognised by the numbers of neighbours of some thirty vertices around an edge, and
/// followed from there over all their faces; a piece counts only if every one of its faces then is one of `mesh`. Where it is in
/// several places of `mesh`, since that is symmetric, the one counts where it lies nearest to the mesh made `scale` times as
/// large. Nothing for meshes so regular that no neighbourhood is found in few places, and for pieces too small for one
/// (`no_index`). O(n).
std::vector<Index> shared_vertices(const Mesh& mesh, const Mesh& fragment, double scale = 1,
                                   const std::vector<bool>& broken = {});

}  // namespace ostraka
