// The two subdivision operations: splitting each triangle into four, or one edge into two.
#pragma once

#include "ostraka/remesh/refine.h"

namespace ostraka {

/// The midpoint of two points, without overflow and independent of their order.
inline Point midway(const Point& p, const Point& q) {
    return {p.x() / 2 + q.x() / 2, p.y() / 2 + q.y() / 2, p.z() / 2 + q.z() / 2};
}

/// Links three consecutive halfedges into a face.
inline void link_triangle(Mesh& mesh, Face face, Halfedge a, Halfedge b, Halfedge c) {
    for (const Halfedge h : {a, b, c}) mesh.set_face(h, face);
    mesh.set_next(a, b), mesh.set_next(b, c), mesh.set_next(c, a);
    mesh.set_halfedge(face, a);
}

/// Subdivides every triangle into four in place. With V, E, F the numbers of old elements, edge e becomes edges e and E + e; face
/// f becomes the middle face f and the corner faces F + 3 f + k; the midpoint of edge e is vertex V + e. `smooth`: true to move
/// points by Loop's scheme. Updates `result`.
void cut_into_four(Mesh& mesh, bool smooth, RefineResult& result);

/// Splits edges at their midpoints, the longest edge first, until the mesh has `vertices` vertices. Updates `result`.
void halve_longest_edges(Mesh& mesh, std::size_t vertices, RefineResult& result);

}  // namespace ostraka
