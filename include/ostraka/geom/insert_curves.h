// Insertion of surface curves as edges of the mesh.
#pragma once

#include "ostraka/geom/surface_trace.h"
#include "ostraka/mesh/mesh.h"

#include <map>
#include <utility>
#include <vector>

namespace ostraka {

/// A mesh in which curves have become edges.
struct InsertedCurves {
    Mesh mesh;  ///< the subdivided mesh: old vertices first, with unchanged indices; the surface is unchanged
    std::vector<Index> face_origin;  ///< for each face of `mesh`: index of the old face that contains it
    /// For each curve and each of its nodes: index of the vertex in `mesh`.
    std::vector<std::vector<Index>> node_vertex;
    /// For each curve: all vertices along the curve; consecutive vertices are connected by an edge.
    std::vector<std::vector<Index>> paths;
    std::vector<SurfacePoint> new_points;  ///< for each new vertex: its position on the old mesh
    /// Index of an old edge -> new vertices on the edge, in order from the source of the edge's first halfedge.
    std::map<Index, std::vector<Index>> on_edge;
};

/// Adds a vertex at each node of the curves and subdivides the faces so that each piece of a curve becomes an edge, or a path of
/// edges if curves cross inside a face (constrained Delaunay triangulation of each crossed face, in its plane). Nodes with the
/// same element and the same position become one vertex. The faces that replace an old face take its position in the order of
/// faces. Time: linear in the size of the mesh plus O(k log k) per face with k nodes. Throws Error (input) for a node out of
/// range.
InsertedCurves insert_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

/// For each face that curves traverse: the fraction of its area to the left of the curves; for faces in `rings` rings around the
/// curves: 1 or 0. The list is sorted by face index, and the mesh is not changed. Pieces of curves that cross another piece
/// inside a face are ignored. Cost: O(k log k) per face with k nodes.
std::vector<std::pair<Index, double>> left_area_fractions(const Mesh& mesh, const std::vector<SurfaceCurve>& curves,
                                                          int rings = 0);

}  // namespace ostraka
