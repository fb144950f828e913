// Labels of faces from what mesh files of other programs hold: label properties, whole numbers, groups, materials, colours.
#pragma once

#include "operations/operations.h"

#include <map>

namespace ostraka {

/// Labels of a mesh's faces.
struct MeshLabels {
    std::vector<std::int32_t> of_face;          ///< one per face; no_label: none
    std::map<std::int32_t, std::string> names;  ///< names from the file, such as those of groups
    std::string source;                         ///< what they were read from, in words; empty: a property "label"
};

/// Sources that `labels_from` accepts besides "values:NAME".
const std::vector<std::string>& label_sources();

/// Labels of the faces of a mesh file. `source`: "label" (the label property), "group", "object" (of an OBJ file), "material",
/// "colour" (one label per colour of the faces, or else of the vertices), "values:NAME" (whole numbers of a property), or empty:
/// the label property, or else the only property of whole numbers whose name suggests labels, segments, classes, clusters or
/// parts. Labels of vertices become those of faces by majority. `path`: the file; empty for an object in memory. Throws Error
/// (input), naming `where`, if there are none.
MeshLabels labels_from(const MeshFile& file, const Path& path, const std::string& source, const std::string& where);

/// Labels of the faces of `mesh` from a file: .npy (whole numbers, integer or real) or text (one per line), for faces, polygons
/// or vertices. Throws Error (input) as `read_labels` does.
MeshLabels labels_in_file(const Path& labels, const MeshFile& mesh);

}  // namespace ostraka
