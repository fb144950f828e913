// Annotated parts of a mesh as a mesh of their own.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/geom/submesh.h"

namespace ostraka {

/// A part cut out along its outlines, with what is annotated on it.
struct CutPart {
    Mesh mesh;
    AnnotationSet annotations;     ///< what lies on it as it was; outlines that were free follow its edges
    std::vector<Index> vertices;   ///< of `whole`, for each vertex
    std::vector<Index> faces;      ///< of `whole`, for each face; no_index where a face closes a cut
    std::size_t cuts = 0;          ///< borders that the object did not have, or not altogether
    std::size_t closed = 0;        ///< of these, closed by triangles
    std::optional<CutMesh> whole;  ///< the mesh cut along free outlines; none where none is free: then the mesh itself
};

/// Cuts regions (places in the set) out of a mesh, without others; no `regions`: everything that is not left out. `close` closes
/// the borders that the cut made by triangles, which are annotated as "cut", where the set had none of that tag with it. Throws
/// Error (input) where one of them is no region or nothing is left.
CutPart cut_out_part(const Mesh& mesh, const AnnotationSet& set, const std::vector<std::size_t>& regions,
                     const std::vector<std::size_t>& left_out = {}, bool close = false);

}  // namespace ostraka
