// Attributes of a mesh carried to a mesh whose elements come from its elements.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// From which elements of another mesh the elements of a mesh come; no_index: from none. Null: from the elements with the same
/// indices.
struct ElementSources {
    const std::vector<Index>* vertices = nullptr;  ///< for each vertex, the vertex
    const std::vector<Index>* faces = nullptr;     ///< for each face, the face
    const std::vector<Index>* corners = nullptr;   ///< for each corner of each face, the corner
};

/// The attributes of the other mesh for each element: colours, labels, texture, materials, values. Elements that come from none
/// get white, label 0, texture coordinates (0, 0), no material and NaN. Tetrahedra are not carried. Takes linear time.
MeshExtras carried(const MeshExtras& extras, const ElementSources& sources);

/// For each corner of a part of a mesh, the corner of the whole mesh: that of the same vertex in the same face. `vertices`,
/// `faces`: for each vertex and face of the part, that of the whole; no_index: none. Takes linear time.
std::vector<Index> corner_sources(const Mesh& part, const std::vector<Index>& vertices, const std::vector<Index>& faces,
                                  const Mesh& whole);

/// For each edge, whether it is a seam: its two faces have different texture coordinates or materials.
std::vector<bool> texture_seams(const Mesh& mesh, const MeshExtras& extras);

}  // namespace ostraka
