// A subset of the faces of a mesh as a separate mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

struct SubMesh {
    Mesh mesh;
    std::vector<Index> vertices;  ///< index in the whole mesh of each vertex
    std::vector<Index> faces;     ///< index in the whole mesh of each face, ascending
};

/// The faces marked in `keep` (one flag per face), or only the edge-connected piece of them with the largest area (among equal
/// ones, the one with the lowest face). A vertex at which they form several fans is duplicated for each fan. Empty if no face
/// is marked. Throws Error (usage) unless there is one flag per face.
SubMesh keep_faces(const Mesh& mesh, const std::vector<bool>& keep, bool largest_only = false);

/// The lowest border halfedge of each hole.
std::vector<Halfedge> holes_of(const Mesh& mesh);
/// Closes the hole at a border halfedge by triangles between its vertices with minimum dihedral angle and area (Liepa 2003).
/// Returns the number of triangles; 0, with the mesh unchanged, if there is no such triangulation.
std::size_t close_hole(Mesh& mesh, Halfedge border);

}  // namespace ostraka
