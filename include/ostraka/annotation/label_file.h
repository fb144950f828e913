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
/// `polygon_of_triangle` maps triangles to the file's polygons (empty: all polygons are triangles); the file may have one line
/// per polygon or one line per triangle. Returns one label per triangle. Throws Error (input) with file and line.
std::vector<std::int32_t> read_labels(const Path& file, std::size_t face_count,
                                      const std::vector<Index>& polygon_of_triangle = {});
/// Writes a label file: one label per line.
void write_labels(const Path& file, const std::vector<std::int32_t>& labels);

/// Names of labels: a JSON object {"0": "head", ...} or list ["head", ...]. Throws Error (input).
std::map<std::int32_t, std::string> read_label_names(const Path& file);

/// One region per label except `no_label`, ascending: the id is the label, the tag is the label's name or "part N", and
/// colour_regions assigns the colours. Time: linear in the size of the mesh.
AnnotationSet regions_from_labels(const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                                  const std::map<std::int32_t, std::string>& names = {});

/// For each face, the label that at least two of its corners have; if all three corners differ, the label of the first corner.
std::vector<std::int32_t> face_labels_from_vertices(const Mesh& mesh, const std::vector<std::int32_t>& vertex_labels);

/// Labels of the faces of a mesh.
struct FaceLabels {
    std::vector<std::int32_t> of_face;  ///< one label per face
    double lost = 0;                    ///< fraction of the mesh's area with a wrong label, because free outlines cut faces
};
/// For each face, the id of the smallest region (by area, then by position in the set) that covers the face; regions of the whole
/// object are ignored. A face cut by free outlines gets the id of the region that covers most of its area.
FaceLabels face_labels(AnnotatedMeshView object);
/// One label per face: `of_face` of `face_labels`.
std::vector<std::int32_t> labels_of(AnnotatedMeshView object);

}  // namespace ostraka
