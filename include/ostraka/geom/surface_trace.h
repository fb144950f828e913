// Straight lines traced over a mesh from face to face.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_search.h"

#include <optional>
#include <vector>

namespace ostraka {

/// A position on the surface, given by the lowest-dimensional element that contains it.
struct SurfaceNode {
    enum class Kind { vertex, edge, face };
    Kind kind = Kind::vertex;
    Index element = no_index;                    ///< vertex, edge or face index
    double parameter = 0;                        ///< on an edge: 0 at the source of halfedge(e, 0), 1 at its target
    std::array<double, 3> barycentric{1, 0, 0};  ///< in a face
    Point point{0, 0, 0};
};

/// Barycentric coordinates below `snap` are set to zero, so that a node near an edge or a vertex is placed on it.
SurfaceNode surface_node(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric, double snap = 1e-6);
SurfaceNode surface_node(const Mesh& mesh, Vertex vertex);
/// The faces that contain the node.
std::vector<Face> faces_of(const Mesh& mesh, const SurfaceNode& node);

/// A surface position without coordinates: it stays on its element when vertices move.
struct SurfacePlace {
    SurfaceNode::Kind kind = SurfaceNode::Kind::vertex;
    std::array<Index, 2> element{no_index, no_index};  ///< the vertex; the ends of the edge, lower index first; the face
    std::array<double, 2> weights{0, 0};               ///< edge: fraction from its first end; face: weights of its corners 1, 2
    bool operator==(const SurfacePlace&) const = default;
    auto operator<=>(const SurfacePlace&) const = default;
};
SurfacePlace place_of(const Mesh& mesh, const SurfaceNode& node);
/// Throws Error (input) if the mesh does not have the element or if the weights lie outside it.
SurfaceNode node_at(const Mesh& mesh, const SurfacePlace& place);

/// A curve on the surface: each piece nodes[i] -> nodes[i + 1] lies in one face.
struct SurfaceCurve {
    std::vector<SurfaceNode> nodes;
    std::vector<Index> faces;  ///< one per piece: the face that contains it (either face for a piece along an edge)
    [[nodiscard]] double length() const;
};

/// The lowest face that contains both nodes; no_index if there is none.
Index common_face(const Mesh& mesh, const SurfaceNode& a, const SurfaceNode& b);

/// The edge that contains both nodes; no_index if there is none or if a node lies inside a face.
Index common_edge(const Mesh& mesh, const SurfaceNode& a, const SurfaceNode& b);

/// The curve through places, each two consecutive ones of which lie in a common face. Throws Error (input) as `node_at` does,
/// and if consecutive places have no common face.
SurfaceCurve curve_through(const Mesh& mesh, const std::vector<SurfacePlace>& places);

/// Traces the intersection of the surface with the plane through both nodes and the direction `up` (for example the mean
/// surface normal) from `from` to `to`. nullopt if the trace reaches the border, does not reach `to`, or becomes longer than
/// `limit`. Linear in the number of faces crossed.
std::optional<SurfaceCurve> trace_line(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to, const Vector& up,
                                       double limit);

}  // namespace ostraka
