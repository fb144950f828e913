// Faces that hang together.
#pragma once

#include "ostraka/core/mesh.h"

namespace ostraka {

/// The faces reached from `start` over edges, in breadth-first order, `start` first: those not `seen` yet, which are from then
/// on. A halfedge of a face reached is crossed if `crosses(halfedge)` is true; it is asked once for each, also on the border.
template <class Crosses>
std::vector<Face> flood_faces(const Mesh& mesh, Face start, std::vector<bool>& seen, Crosses&& crosses) {
    std::vector<Face> reached{start};
    seen[start] = true;
    for (std::size_t i = 0; i < reached.size(); ++i)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(reached[i]))) {
            if (!crosses(h)) continue;
            const Face next = mesh.face(mesh.opposite(h));
            if (next == Mesh::null_face() || seen[next]) continue;
            seen[next] = true;
            reached.push_back(next);
        }
    return reached;
}
/// Over all edges: the rest of the connected component.
inline std::vector<Face> flood_faces(const Mesh& mesh, Face start, std::vector<bool>& seen) {
    return flood_faces(mesh, start, seen, [](Halfedge) { return true; });
}

}  // namespace ostraka
