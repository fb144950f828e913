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

/// A curve over the surface: each piece nodes[i] -> nodes[i + 1] lies in one face.
struct SurfaceCurve {
    std::vector<SurfaceNode> nodes;
    std::vector<Index> faces;  ///< one per piece: the face that holds it (either one for a piece along an edge)
    [[nodiscard]] double length() const;
};

/// Follows the plane through both nodes and the direction `up` (the mean surface normal, say) over the surface, from
/// `from` to `to`. Nothing if the walk meets the border, does not arrive, or grows longer than `limit`.
/// Linear in the number of faces crossed.
std::optional<SurfaceCurve> trace_line(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to, const Vector& up,
                                       double limit);

}  // namespace ostraka
