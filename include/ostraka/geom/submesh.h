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

/// For each face, the number of its piece (ordered by the lowest face of the piece); `no_index`: in no piece.
struct FacePieces {
    std::vector<Index> of_face;
    Index count = 0;
};
/// Connected pieces of the faces for which `counts` is true. Two such faces are connected across a halfedge h from the first to
/// the second if `joins(h)` is true.
template <class Counts, class Joins>
FacePieces face_pieces(const Mesh& mesh, Counts&& counts, Joins&& joins) {
    FacePieces pieces{std::vector<Index>(mesh.number_of_faces(), no_index)};
    std::vector<Face> stack;
    for (const Face first : mesh.faces()) {
        if (!counts(first) || pieces.of_face[first] != no_index) continue;
        stack.assign(1, first);
        pieces.of_face[first] = pieces.count;
        while (!stack.empty()) {
            const Face face = stack.back();
            stack.pop_back();
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face))) {
                const Face other = mesh.face(mesh.opposite(h));
                if (other == Mesh::null_face() || !counts(other) || pieces.of_face[other] != no_index || !joins(h)) continue;
                pieces.of_face[other] = pieces.count;
                stack.push_back(other);
            }
        }
        ++pieces.count;
    }
    return pieces;
}

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
