// Some faces of a mesh as a mesh of its own.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

struct SubMesh {
    Mesh mesh;
    std::vector<Index> vertices;  ///< of the whole mesh, for each vertex
    std::vector<Index> faces;     ///< of the whole mesh, for each face, ascending
};

/// Of each face the number of the piece that it is in, by the pieces' lowest faces; `no_index`: in none.
struct FacePieces {
    std::vector<Index> of_face;
    Index count = 0;
};
/// Pieces of the faces that `counts`, joined over the edges that `joins(halfedge)` lets pass: from its face to the opposite one,
/// both of which count.
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

/// The faces marked in `keep` (one entry a face), or of them only the piece joined over edges that has the largest area (the one
/// with the lowest face of equal ones). A vertex at which they form several fans is there once for each. Empty where none is
/// marked. Throws Error (usage) if the marks are not one a face.
SubMesh keep_faces(const Mesh& mesh, const std::vector<bool>& keep, bool largest_only = false);

/// The border halfedge of lowest index of each hole.
std::vector<Halfedge> holes_of(const Mesh& mesh);
/// Closes the hole at a border halfedge by triangles between its vertices, of minimum dihedral angle and area (Liepa 2003); gives
/// their number. 0, and the mesh as it was, where there is no such triangulation.
std::size_t close_hole(Mesh& mesh, Halfedge border);

}  // namespace ostraka
