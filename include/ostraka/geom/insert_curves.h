// Insertion of surface curves as edges of the mesh.
#pragma once

#include "ostraka/geom/surface_trace.h"
#include "ostraka/mesh/mesh.h"

#include <map>
#include <utility>
#include <vector>

namespace ostraka {

struct InsertedCurves {
    Mesh mesh;                                    ///< old vertices first, with unchanged indices; the surface is unchanged
    std::vector<Index> face_origin;               ///< new face -> old face
    std::vector<std::vector<Index>> node_vertex;  ///< per curve and node: its vertex
    std::vector<std::vector<Index>> paths;        ///< per curve: all vertices along it, consecutive ones connected by an edge
    std::vector<SurfacePoint> new_points;         ///< for each new vertex, its place on the old mesh
    std::map<Index, std::vector<Index>> on_edge;  ///< old edge -> new vertices on it, from the source of its first halfedge
};

/// Adds a vertex at each node of the curves and subdivides the faces so that each piece of a curve becomes an edge, or a path
/// of edges if curves cross inside a face (constrained Delaunay triangulation of each crossed face, in its plane). Nodes with
/// the same element and the same position become one vertex. New faces take the position of their old face in the order. Linear
/// in the size of the mesh plus O(k log k) per face with k nodes. Throws Error (input) for a node out of range.
InsertedCurves insert_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

/// For each face that the curves traverse, the fraction of its area to their left, without changing the mesh; for `rings` rings
/// of faces around them, 1 or 0. Ascending by face. Pieces that cross another one inside a face are ignored. Cost as above, for
/// these faces only.
std::vector<std::pair<Index, double>> left_shares(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, int rings = 0);

}  // namespace ostraka
