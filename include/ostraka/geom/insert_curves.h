// Curves over the surface made into edges of the mesh.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_trace.h"

#include <map>
#include <utility>
#include <vector>

namespace ostraka {

struct InsertedCurves {
    Mesh mesh;                                    ///< old vertices first, under their old indices; the surface is unchanged
    std::vector<Index> face_origin;               ///< new face -> old face
    std::vector<std::vector<Index>> node_vertex;  ///< per curve and node: the vertex at it
    std::vector<std::vector<Index>> paths;        ///< per curve: all vertices along it, neighbours joined by an edge
    std::vector<SurfaceNode> new_nodes;           ///< of the vertices beyond the old ones: where they are on the old mesh
    std::map<Index, std::vector<Index>> on_edge;  ///< old edge -> new vertices on it, from the source of its first halfedge
};

/// Adds a vertex at each node of the curves and cuts the faces so that each piece of a curve is an edge, or a path of edges
/// where curves cross inside a face (constrained Delaunay triangulation of each face that is crossed, in its plane).
/// Nodes with the same element and the same place become one vertex. New faces stand where their old face stood.
/// Linear in the mesh plus O(k log k) per face with k nodes. Throws Error (input) for a node out of range.
InsertedCurves insert_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

/// For each face that the curves run through, the share of its area that lies to their left, without changing the mesh; for
/// `rings` rings of faces around them, 1 or 0. Ascending by face. A piece that crosses another one inside a face is left out of
/// the account. Cost as above, for these faces only.
std::vector<std::pair<Index, double>> left_shares(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, int rings = 0);

}  // namespace ostraka
