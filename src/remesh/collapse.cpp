#include "remesh/collapse.h"

namespace ostraka {

namespace {

/// Whether both edges at the corner opposite to h lie on the border: the collapse would leave them without a face.
bool is_ear(const Mesh& mesh, Halfedge h) {
    return mesh.is_border(mesh.opposite(mesh.next(h))) && mesh.is_border(mesh.opposite(mesh.prev(h)));
}

}  // namespace

bool may_collapse(const Mesh& mesh, Halfedge h) {
    const Halfedge o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    const bool left = !mesh.is_border(h), right = !mesh.is_border(o);
    if (!left && !right) return false;
    if (left && is_ear(mesh, h)) return false;
    if (right && is_ear(mesh, o)) return false;
    if (left && right && mesh.is_border(u, false) && mesh.is_border(v, false)) return false;
    const Vertex w = left ? mesh.target(mesh.next(h)) : Mesh::null_vertex();
    const Vertex x = right ? mesh.target(mesh.next(o)) : Mesh::null_vertex();
    if (w == x) return false;

    // Counts common neighbours from the end with the smaller ring: both rings are traversed side by side until one is closed,
    // so that a vertex of very high valence costs no more than its neighbour.
    const Halfedge first_u = mesh.opposite(h), first_v = h;
    Halfedge at_u = first_u, at_v = first_v;
    std::size_t valence = 0;
    do {
        at_u = mesh.opposite(mesh.next(at_u)), at_v = mesh.opposite(mesh.next(at_v));
        ++valence;
    } while (at_u != first_u && at_v != first_v);
    const bool same_valence = at_u == first_u && at_v == first_v;
    const Halfedge small = at_u == first_u ? first_u : first_v, large = small == first_u ? first_v : first_u;
    const Vertex other = mesh.target(large);
    std::size_t common = 0;
    for_each_incoming(mesh, small, [&](Halfedge g) {
        const Vertex y = mesh.source(g);
        if (y == other) return;
        if (y == w || y == x) ++common;
        else for_each_incoming(mesh, y, [&](Halfedge k) { common += mesh.source(k) == other; });
    });
    if (common != static_cast<std::size_t>(left) + static_cast<std::size_t>(right)) return false;
    // Both opposite corners joined by an edge that closes the link: the component is a tetrahedron.
    return !(left && right && same_valence && valence == 3);
}

namespace {

/// Replaces `outer` by `kept` in the face (or border) beyond a removed face.
void replace(Mesh& mesh, Halfedge outer, Halfedge kept) {
    const Face beyond = mesh.face(outer);
    mesh.set_face(kept, beyond);
    mesh.set_next(mesh.prev(outer), kept);
    mesh.set_next(kept, mesh.next(outer));
    if (beyond.is_valid() && mesh.halfedge(beyond) == outer) mesh.set_halfedge(beyond, kept);
}

}  // namespace

void collapse(Mesh& mesh, Halfedge h, CollapseVisitor* visitor) {
    const Halfedge o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    if (visitor != nullptr) visitor->merge_vertices(mesh, v, u);
    for_each_incoming(mesh, u, [&](Halfedge g) { mesh.set_target(g, v); });
    const bool left = !mesh.is_border(h), right = !mesh.is_border(o);
    const Halfedge kept_incoming = left ? mesh.opposite(mesh.next(h)) : mesh.prev(o);  // ends in v
    if (left) {
        const Halfedge kept = mesh.next(h), removed = mesh.prev(h), outer = mesh.opposite(removed);  // v -> w, w -> u, u -> w
        const Vertex w = mesh.target(kept);
        if (visitor != nullptr) visitor->merge_edges(mesh, mesh.edge(kept), mesh.edge(removed));
        if (visitor != nullptr) visitor->replace_halfedge(mesh, kept, outer);
        mesh.remove_face(mesh.face(h));
        replace(mesh, outer, kept);
        if (mesh.halfedge(w) == outer) mesh.set_halfedge(w, kept);
        mesh.remove_edge(mesh.edge(removed));
    } else {
        mesh.set_next(mesh.prev(h), mesh.next(h));
    }
    if (right) {
        const Halfedge kept = mesh.prev(o), removed = mesh.next(o), outer = mesh.opposite(removed);  // x -> v, u -> x, x -> u
        const Vertex x = mesh.source(kept);
        if (visitor != nullptr) visitor->merge_edges(mesh, mesh.edge(kept), mesh.edge(removed));
        if (visitor != nullptr) visitor->replace_halfedge(mesh, kept, outer);
        mesh.remove_face(mesh.face(o));
        replace(mesh, outer, kept);
        if (mesh.halfedge(x) == removed) mesh.set_halfedge(x, mesh.opposite(kept));
        mesh.remove_edge(mesh.edge(removed));
    } else {
        mesh.set_next(mesh.prev(o), mesh.next(o));
    }
    mesh.remove_edge(mesh.edge(h));
    mesh.remove_vertex(u);
    // Surface_mesh requires a border halfedge at a border vertex.
    Halfedge at_v = kept_incoming;
    for_each_incoming(mesh, kept_incoming, [&](Halfedge g) {
        if (mesh.is_border(g)) at_v = g;
    });
    mesh.set_halfedge(v, at_v);
}

}  // namespace ostraka
