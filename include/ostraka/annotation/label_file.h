// Labels: one integer per element, as in the label files of mesh segmentation benchmarks and label properties of PLY files.
// Conversion from and to regions.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/files/file.h"

#include <map>

namespace ostraka {

/// The label of a face without a region.
inline constexpr std::int32_t no_label = -1;

/// Reads a label file: one integer per line, one line per face of the mesh file; blank lines at the end are ignored.
/// `triangle_polygon` maps triangles to the file's polygons (empty: all polygons are triangles); the number of lines may be
/// that of the polygons or that of the triangles. Returns one label per triangle. Throws Error (input) with file and line.
std::vector<std::int32_t> read_labels(const Path& file, std::size_t face_count, const std::vector<Index>& triangle_polygon = {});
void write_labels(const Path& file, const std::vector<std::int32_t>& labels);

/// Names of labels: a JSON object {"0": "head", ...} or list ["head", ...]. Throws Error (input).
std::map<std::int32_t, std::string> read_label_names(const Path& file);

/// One region per label except `no_label`, ascending: id = label, tag = its name or "part N", colours by colour_regions.
/// Linear.
AnnotationSet regions_from_labels(const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                                  const std::map<std::int32_t, std::string>& names = {});

/// The label of at least two corners of the face; that of the first corner if all three differ.
std::vector<std::int32_t> face_labels_from_vertices(const Mesh& mesh, const std::vector<std::int32_t>& vertex_labels);

/// Labels of faces, and the fraction of the area with a wrong label because free outlines cut faces.
struct FaceLabels {
    std::vector<std::int32_t> of_face;
    double lost = 0;
};
/// For each face, the id of the smallest region (by area, then by position in the set) that covers it, ignoring the whole
/// object. A face that free outlines cut gets the id that covers most of its area.
FaceLabels face_labels(AnnotatedMeshView object);
std::vector<std::int32_t> labels_of(AnnotatedMeshView object);

}  // namespace ostraka
