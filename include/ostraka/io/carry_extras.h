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

/// Texture coordinates of a mesh each of whose faces lies in a face of another mesh: for each corner, those of its position in
/// the triangle `origin[face]`; no_index: (0, 0). `texture`: three texture coordinates for each face of `other`, as in
/// MeshExtras::corner_texture. Takes linear time.
std::vector<TexturePoint> texture_at_positions(const Mesh& mesh, const std::vector<Index>& origin, const Mesh& other,
                                               const std::vector<TexturePoint>& texture);

/// Number of edges whose two faces have different texture coordinates or materials: the seams. For each edge, whether it is one.
std::vector<bool> texture_seams(const Mesh& mesh, const MeshExtras& extras);

}  // namespace ostraka
