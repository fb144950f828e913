// Insertion of surface curves as edges of the mesh.
#pragma once

#include "ostraka/geom/surface_trace.h"
#include "ostraka/mesh/mesh.h"

#include <map>
#include <utility>
#include <vector>

namespace ostraka {

/// A mesh that was subdivided so that given curves are paths of edges.
struct InsertedCurves {
    Mesh mesh;  ///< the subdivided mesh: old vertices first, with unchanged indices; the surface is unchanged
    std::vector<Index> face_origin;  ///< for each face of `mesh`: index of the old face that contains it
    /// For each curve and each of its nodes: index of the vertex in `mesh`.
    std::vector<std::vector<Index>> node_vertex;
    /// For each curve: all vertices along the curve; consecutive vertices are connected by an edge.
    std::vector<std::vector<Index>> paths;
    std::vector<SurfacePoint> new_points;  ///< for each new vertex: its position on the old mesh
    /// For each subdivided old edge (by index): the new vertices on this edge, in order from the source of the edge's first
    /// halfedge.
    std::map<Index, std::vector<Index>> on_edge;
};

/// Adds a vertex at each node of the curves and subdivides the faces so that each piece of a curve becomes an edge, or a path of
/// edges if curves cross inside a face (constrained Delaunay triangulation of each crossed face, in its plane). Nodes with the
/// same element and the same position become one vertex. The new faces of a subdivided face come in the order of faces at the
/// position of the old face. Time: linear in the size of the mesh plus O(k log k) per face with k nodes. Throws Error (input)
/// for a node out of range.
InsertedCurves insert_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

/// Computes for each face that curves traverse the fraction of its area to the left of the curves. With `rings` above 0, the
/// faces in that many rings around the curves are added, with the fraction 1 (left) or 0 (right). The list is sorted by face
/// index, and the mesh is not changed. Segments of curves that cross another segment inside a face are ignored. Time: O(k log
/// k) per face with k nodes.
std::vector<std::pair<Index, double>> left_area_fractions(const Mesh& mesh, const std::vector<SurfaceCurve>& curves,
                                                          int rings = 0);

}  // namespace ostraka
