// Annotations follow a mesh through maps of its elements, as `mesh repair` writes them.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"

namespace ostraka {

/// A file {"format": "ostraka-map", "version": 1, "kind": "vertex" | "face", "from": count, "to": count, "map": [...]}: for each
/// old element its new index, -1 (no_index) where it was dropped. Throws Error (input) that names file, place and remedy unless
/// kind and counts are those given.
std::vector<Index> read_index_map(const Path& file, const std::string& kind, std::size_t from, std::size_t to);

/// The annotations of `before` on `after`. Faces follow `face_map`; if it is empty, a face follows its corners. Points and
/// poly-lines follow `vertex_map`; a poly-line is cut where its vertices are not joined any more, a region without faces becomes
/// a line or a point; notes say so. Values of measures are marked stale.
AnnotationSet remap_annotations(const Mesh& before, const AnnotationSet& set, const Mesh& after,
                                const std::vector<Index>& vertex_map, const std::vector<Index>& face_map = {});

/// The annotations of `whole` on a piece of it, whose vertices and faces are those listed of the whole. Left out is what is not
/// on the piece as it was: points that lack one, lines and regions of which less than a line or a region is left.
AnnotationSet annotations_of_piece(const Mesh& whole, const AnnotationSet& set, const Mesh& piece,
                                   const std::vector<Index>& vertices, const std::vector<Index>& faces);

/// Labels per face along a map; new faces that no old one maps to get `no_label`.
std::vector<std::int32_t> remap_labels(const std::vector<std::int32_t>& labels, const std::vector<Index>& face_map,
                                       std::size_t face_count);

}  // namespace ostraka
