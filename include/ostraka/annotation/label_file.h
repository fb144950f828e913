// Labels, one integer an element: label files as of mesh segmentation benchmarks and label properties of PLY files, to and from
// regions.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"

#include <map>

namespace ostraka {

/// The label of a face that no region covers.
inline constexpr std::int32_t no_label = -1;

/// Reads a label file: one integer a line, one line a face of the mesh file; blank lines at the end are ignored.
/// `triangle_polygon` maps triangles to the file's polygons (empty: every polygon is a triangle); the count may be that of the
/// polygons or that of the triangles. Returns a label per triangle. Throws Error (input) naming file and line.
std::vector<std::int32_t> read_labels(const Path& file, std::size_t face_count, const std::vector<Index>& triangle_polygon = {});
void write_labels(const Path& file, const std::vector<std::int32_t>& labels);

/// Names of labels: a JSON object {"0": "head", ...} or list ["head", ...]. Throws Error (input).
std::map<std::int32_t, std::string> read_label_names(const Path& file);

/// One region per label but `no_label`, in ascending order: id = label, tag = its name or "part N", colours of
/// colour_regions. Linear.
AnnotationSet regions_from_labels(const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                                  const std::map<std::int32_t, std::string>& names = {});

/// A face gets the label that two of its corners have; the first corner's if all differ.
std::vector<std::int32_t> face_labels_from_vertices(const Mesh& mesh, const std::vector<std::int32_t>& vertex_labels);

/// Labels of faces, and the share of the area that has another one since free outlines cut faces.
struct FaceLabels {
    std::vector<std::int32_t> of_face;
    double lost = 0;
};
/// Per face the id of the smallest region (by area, then by place in the set) that covers it, of a face that free outlines cut
/// that of most of its area; the whole object does not count.
FaceLabels face_labels(const Mesh& mesh, const AnnotationSet& set);
std::vector<std::int32_t> labels_of(const Mesh& mesh, const AnnotationSet& set);

}  // namespace ostraka
