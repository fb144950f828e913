// A subset of the faces of a mesh as a separate mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Some faces of a mesh, as a mesh of their own.
struct SubMesh {
    Mesh mesh;                    ///< the faces as a mesh
    std::vector<Index> vertices;  ///< for each vertex of `mesh`: its index in the whole mesh
    std::vector<Index> faces;     ///< for each face of `mesh`: its index in the whole mesh; ascending
};

/// The faces marked in `keep` (one flag per face) as a separate mesh. With `largest_only`, only the edge-connected component of
/// the largest area is kept (among components of equal area, the one with the smallest face index). A vertex at which the kept
/// faces form several fans is duplicated for each fan. The mesh is empty if no face is marked. Throws Error (usage) unless
/// there is one flag per face.
SubMesh keep_faces(const Mesh& mesh, const std::vector<bool>& keep, bool largest_only = false);

/// One halfedge per hole of the mesh: the border halfedge with the smallest index.
std::vector<Halfedge> holes_of(const Mesh& mesh);
/// Closes the hole at a border halfedge by triangles between the vertices of the hole, with minimum dihedral angles and area
/// (Liepa 2003). Returns the number of triangles. If there is no such triangulation, the mesh is unchanged and the result is 0.
std::size_t close_hole(Mesh& mesh, Halfedge border);

}  // namespace ostraka
