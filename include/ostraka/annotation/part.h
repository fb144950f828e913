// Annotated parts of a mesh as separate meshes.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/geom/submesh.h"

namespace ostraka {

/// A part of an annotated mesh, cut out along its outlines, with the annotations that lie completely on the part; free outlines
/// now follow edges of the part's mesh.
struct CutPart : AnnotatedMesh {
    std::vector<Index> vertices;  ///< for each vertex of the part: its index in `whole`
    /// For each face of the part: its index in `whole`; no_index for faces that close a cut.
    std::vector<Index> faces;
    std::size_t cuts = 0;    ///< number of borders of the part that the cut created, at least in part
    std::size_t closed = 0;  ///< number of cuts closed by triangles
    /// The whole mesh cut along free outlines; none if no annotation is free: indices then refer to the given mesh.
    std::optional<CutMesh> whole;
};

/// Cuts out the union of `regions` (indices into the set; empty: the whole mesh) without the regions in `left_out`. `close`: fill
/// the borders created by the cut with triangles, which are annotated as "cut". Throws Error (input) if an index does not refer
/// to a region or if nothing is left.
CutPart cut_out_part(AnnotatedMeshView object, const std::vector<std::size_t>& regions,
                     const std::vector<std::size_t>& left_out = {}, bool close = false);

}  // namespace ostraka
