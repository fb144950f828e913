// Copies the attributes of a mesh to a mesh derived from it, using maps from new to old elements.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Maps from the elements of a derived mesh to the elements of its source mesh; no_index: the element has no source. A null
/// pointer stands for the identity map.
struct ElementSources {
    const std::vector<Index>* vertices = nullptr;  ///< for each vertex: its source vertex
    const std::vector<Index>* faces = nullptr;     ///< for each face: its source face
    const std::vector<Index>* corners = nullptr;   ///< for each corner of each face: its source corner
};

/// Copies the attributes of the source mesh (colours, labels, texture, materials, values) to the elements of the derived mesh.
/// Elements without a source get white, label 0, texture coordinates (0, 0), no material and the value NaN. Tetrahedra are not
/// copied. Time: linear.
MeshExtras carried(const MeshExtras& extras, const ElementSources& sources);

/// For each corner of a part of a mesh: the corner of the whole mesh at the same vertex in the same face. `vertices`, `faces`:
/// for each vertex and face of the part, its index in the whole mesh; no_index: none. Time: linear.
std::vector<Index> corner_sources(const Mesh& part, const std::vector<Index>& vertices, const std::vector<Index>& faces,
                                  const Mesh& whole);

/// For each edge: true if it is a seam of the texture, that is if its two faces have different texture coordinates or
/// materials.
std::vector<bool> texture_seams(const Mesh& mesh, const MeshExtras& extras);

}  // namespace ostraka
