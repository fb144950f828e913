// Straight lines drawn over a mesh from face to face.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_search.h"

#include <optional>
#include <vector>

namespace ostraka {

/// A place on the surface by the smallest element that holds it.
struct SurfaceNode {
    enum class Kind { vertex, edge, face };
    Kind kind = Kind::vertex;
    Index element = no_index;                    ///< vertex, edge or face index
    double parameter = 0;                        ///< on an edge: 0 at the source of halfedge(e, 0), 1 at its target
    std::array<double, 3> barycentric{1, 0, 0};  ///< in a face
    Point point{0, 0, 0};
};

/// Barycentric coordinates below `snap` are taken for zero, so that a node near an edge or a vertex lies on it.
SurfaceNode surface_node(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric, double snap = 1e-6);
SurfaceNode surface_node(const Mesh& mesh, Vertex vertex);
/// The faces that hold the node.
std::vector<Face> faces_of(const Mesh& mesh, const SurfaceNode& node);

/// The same without coordinates: it stays on its element when vertices move.
struct SurfacePlace {
    SurfaceNode::Kind kind = SurfaceNode::Kind::vertex;
    std::array<Index, 2> element{no_index, no_index};  ///< the vertex; the ends of the edge, the lower first; the face
    std::array<double, 2> weights{0, 0};  ///< on an edge: the share of the way from its first end; in a face: of its corners 1, 2
    bool operator==(const SurfacePlace&) const = default;
    auto operator<=>(const SurfacePlace&) const = default;
};
SurfacePlace place_of(const Mesh& mesh, const SurfaceNode& node);
/// Throws Error (input) for an element that the mesh does not have, or weights that are not in it.
SurfaceNode node_at(const Mesh& mesh, const SurfacePlace& place);

/// A curve over the surface: each piece nodes[i] -> nodes[i + 1] lies in one face.
struct SurfaceCurve {
    std::vector<SurfaceNode> nodes;
    std::vector<Index> faces;  ///< one per piece: the face that holds it (either one for a piece along an edge)
    [[nodiscard]] double length() const;
};

/// A face that holds both nodes, the lowest of several; no_index if there is none.
Index common_face(const Mesh& mesh, const SurfaceNode& a, const SurfaceNode& b);

/// The edge that holds both nodes; no_index if none does, or one of them is inside a face.
Index common_edge(const Mesh& mesh, const SurfaceNode& a, const SurfaceNode& b);

/// The curve through places of which neighbours lie in one face. Throws Error (input) as `node_at`, and for neighbours that share
/// no face.
SurfaceCurve curve_through(const Mesh& mesh, const std::vector<SurfacePlace>& places);

/// Follows the plane through both nodes and the direction `up` (the mean surface normal, say) over the surface, from
/// `from` to `to`. Nothing if the walk meets the border, does not arrive, or grows longer than `limit`.
/// Linear in the number of faces crossed.
std::optional<SurfaceCurve> trace_line(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to, const Vector& up,
                                       double limit);

}  // namespace ostraka
