// Topology of edge collapses.
#pragma once

#include "ostraka/remesh/simplify.h"

namespace ostraka {

/// Whether merging the end vertices of the halfedge keeps a triangle mesh manifold and preserves its topology: the two vertices
/// have no common neighbours except the corners opposite to the edge (Dey et al. 1999), no border is pinched, and neither a
/// tetrahedron nor a single triangle is flattened.
bool may_collapse(const Mesh& mesh, Halfedge h);

/// Merges source(h) into target(h), which keeps its position. Edges of the target remain. Requires may_collapse(mesh, h).
void collapse(Mesh& mesh, Halfedge h, CollapseVisitor* visitor);

/// Calls action(halfedge) for each halfedge that ends where `first` ends.
template <class Action>
void for_each_incoming(const Mesh& mesh, Halfedge first, Action&& action) {
    Halfedge h = first;
    do {
        action(h);
        h = mesh.opposite(mesh.next(h));
    } while (h != first);
}
/// Calls action(halfedge) for each halfedge that ends at `vertex`.
template <class Action>
void for_each_incoming(const Mesh& mesh, Vertex vertex, Action&& action) {
    for_each_incoming(mesh, mesh.halfedge(vertex), action);
}

}  // namespace ostraka
