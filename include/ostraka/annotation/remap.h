// Mapping of annotations to a changed mesh by index maps, as written by `mesh repair`.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// Reads a file {"format": "ostraka-map", "version": 1, "kind": "vertex" | "face", "from": count, "to": count, "map": [...]}:
/// for each old element its new index, -1 (no_index) if it was removed. Throws Error (input) with file, position and remedy
/// unless kind and counts have the given values.
std::vector<Index> read_index_map(const Path& file, const std::string& kind, std::size_t from, std::size_t to);

/// Maps the annotations of `before` to `after`. Faces are mapped by `face_map`, or by their corners if it is empty. Points and
/// poly-lines are mapped by `vertex_map`; a poly-line is split where consecutive vertices are no longer connected, and a region
/// without faces becomes a line or a point; notes report both. Values of measures are marked stale.
AnnotationSet remap_annotations(AnnotatedMeshView before, const Mesh& after, const std::vector<Index>& vertex_map,
                                const std::vector<Index>& face_map = {});

/// The annotations of `whole` on a piece of it; `vertices` and `faces` are the indices in `whole` of the elements of the piece.
/// Point annotations with a missing vertex are dropped, and lines and regions of which neither a line nor a region remains.
AnnotationSet annotations_of_piece(AnnotatedMeshView whole, const Mesh& piece, const std::vector<Index>& vertices,
                                   const std::vector<Index>& faces);

/// Maps labels of faces; new faces without an old face get `no_label`.
std::vector<std::int32_t> remap_labels(const std::vector<std::int32_t>& labels, const std::vector<Index>& face_map,
                                       std::size_t face_count);

}  // namespace ostraka
