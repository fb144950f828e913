// Connected components of faces (flood fill).
#pragma once

#include "ostraka/mesh/mesh.h"

namespace ostraka {

/// Faces that can be reached from `start` across edges, in breadth-first order, `start` first. Only faces not yet marked in
/// `visited` are visited, and visited faces are marked. An edge is crossed if `crosses(halfedge)` is true for the edge's halfedge
/// in the face already reached; `crosses` is called once for each halfedge of a reached face, border edges included.
template <class Crosses>
std::vector<Face> flood_faces(const Mesh& mesh, Face start, std::vector<bool>& visited, Crosses&& crosses) {
    std::vector<Face> reached{start};
    visited[start] = true;
    for (std::size_t i = 0; i < reached.size(); ++i)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(reached[i]))) {
            if (!crosses(h)) continue;
            const Face next = mesh.face(mesh.opposite(h));
            if (next == Mesh::null_face() || visited[next]) continue;
            visited[next] = true;
            reached.push_back(next);
        }
    return reached;
}
/// Faces that can be reached from `start` across any edges: the connected component without the faces already visited.
inline std::vector<Face> flood_faces(const Mesh& mesh, Face start, std::vector<bool>& visited) {
    return flood_faces(mesh, start, visited, [](Halfedge) { return true; });
}

}  // namespace ostraka
