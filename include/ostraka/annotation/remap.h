// Maps annotations to a changed mesh by index maps; `mesh repair` writes such maps.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// Reads a file {"format": "ostraka-map", "version": 1, "kind": "vertex" | "face", "from": count, "to": count, "map": [...]}:
/// `map` gives for each old element its new index, or -1 (read as no_index) if the element was removed. Throws Error (input) with
/// file, position and remedy unless the kind and the two counts in the file equal the arguments.
std::vector<Index> read_index_map(const Path& file, const std::string& kind, std::size_t from, std::size_t to);

/// Maps the annotations of `before` to `after`. Faces are mapped by `face_map`, or, if `face_map` is empty, by the corners of the
/// faces. Points and poly-lines are mapped by `vertex_map`; a poly-line is split where consecutive vertices are no longer
/// connected, and a region without faces becomes a line or a point; notes report split lines and converted regions. Values of
/// measures are marked stale.
AnnotationSet remap_annotations(AnnotatedMeshView before, const Mesh& after, const std::vector<Index>& vertex_map,
                                const std::vector<Index>& face_map = {});

/// Restricts the annotations of `whole` to a piece of the mesh; `vertices` and `faces` give for each vertex and face of the piece
/// its index in `whole`. Point annotations with a vertex outside the piece are dropped. Lines without an edge in the piece are
/// dropped, and regions without a face or a line in the piece.
AnnotationSet annotations_of_piece(AnnotatedMeshView whole, const Mesh& piece, const std::vector<Index>& vertices,
                                   const std::vector<Index>& faces);

/// Maps labels of old faces to the `face_count` new faces by `face_map` (for each old face, its new face); new faces without an
/// old face get `no_label`.
std::vector<std::int32_t> remap_labels(const std::vector<std::int32_t>& labels, const std::vector<Index>& face_map,
                                       std::size_t face_count);

}  // namespace ostraka
