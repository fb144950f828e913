// Points on the surface of a mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <array>
#include <compare>
#include <string>
#include <tuple>
#include <vector>

namespace ostraka {

/// A point on the surface of a mesh, given by the element (vertex, edge or face) that contains the point and by weights, without
/// coordinates: the point stays on its element when vertices move (compare SurfacePoint of geometry-central, Sharp et al. 2019).
/// An edge is named by its two vertices, as in files, so that a point does not depend on edge indices.
struct SurfacePoint {
    enum class Kind : std::uint8_t { vertex, edge, face };
    Kind kind = Kind::vertex;
    /// By kind: the index of the vertex; the vertex indices of the two ends of the edge, in either order; the index of the
    /// face. Unused entries are no_index.
    std::array<Index, 2> element{no_index, no_index};
    /// Barycentric weights of the vertex, of both ends of the edge, or of corners(mesh, face). Their sum is 1.
    std::array<double, 3> weights{1, 0, 0};

    [[nodiscard]] bool is_vertex() const { return kind == Kind::vertex; }
    [[nodiscard]] bool is_on_edge() const { return kind == Kind::edge; }
    [[nodiscard]] bool is_in_face() const { return kind == Kind::face; }
    [[nodiscard]] Vertex vertex() const { return Vertex(element[0]); }
    [[nodiscard]] Face face() const { return Face(element[0]); }

    bool operator==(const SurfacePoint&) const = default;
    /// Orders points by element, then by the second and third weight, then by the first.
    std::partial_ordering operator<=>(const SurfacePoint& other) const {
        return std::tie(kind, element, weights[1], weights[2], weights[0]) <=>
               std::tie(other.kind, other.element, other.weights[1], other.weights[2], other.weights[0]);
    }
};

SurfacePoint vertex_point(Index vertex);  ///< the point at a vertex
/// The point on an edge at the fraction `fraction` of the way from vertex `from` to vertex `to`.
SurfacePoint edge_point(Index from, Index to, double fraction);
/// The point on an edge at the fraction `fraction` from vertex `from` to vertex `to`, stored with the smaller vertex index first.
SurfacePoint ordered_edge_point(Index from, Index to, double fraction);
/// The point of a face with these barycentric weights.
SurfacePoint face_point(Index face, const std::array<double, 3>& weights);
/// The point of a face with these barycentric weights. Weights below `snap` are set to zero, so that a point near an edge or a
/// vertex is placed on that edge or vertex.
SurfacePoint surface_point(const Mesh& mesh, Index face, const std::array<double, 3>& weights, double snap = 1e-6);
/// The point on an edge at this fraction of `halfedge`. Weights below `snap` are set to zero, so that a point near an end is
/// placed at that vertex.
SurfacePoint surface_point(const Mesh& mesh, Halfedge halfedge, double fraction, double snap = 1e-6);

/// The unique form in which annotations store a point: the smaller vertex index of an edge comes first, and the first weight is
/// computed from the others.
SurfacePoint stored_point(const Mesh& mesh, const SurfacePoint& p);

/// Name of the point's element for messages: "vertex 3", "the edge from vertex 1 to vertex 2", "face 4".
std::string element_name(const SurfacePoint& p);
/// True if the mesh has the point's element.
bool has_element(const Mesh& mesh, const SurfacePoint& p);
/// Throws Error (input) if the mesh does not have the point's element or if the weights lie outside the element.
void check_surface_point(const Mesh& mesh, const SurfacePoint& p);

/// The coordinates of a point.
Point position(const Mesh& mesh, const SurfacePoint& p);
/// The coordinates of several points.
std::vector<Point> positions(const Mesh& mesh, const std::vector<SurfacePoint>& points);
/// True for points on the same element with the same coordinates.
bool same_point(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b);

/// The edge that contains a point of kind edge.
Edge edge_of(const Mesh& mesh, const SurfacePoint& p);
/// Position of a point on an edge, as a fraction along halfedge(edge, 0).
double fraction_along(const Mesh& mesh, Edge edge, const SurfacePoint& p);

/// The one, two or three vertices of the point's element, with weights. The vertices of an edge are the source and the target of
/// halfedge(edge, 0), so that interpolated values do not depend on the face.
std::vector<std::pair<Vertex, double>> weighted_vertices(const Mesh& mesh, const SurfacePoint& p);
/// Linear interpolation of vertex values at a point; `value(vertex)` returns the value at a vertex.
template <class Value>
auto interpolate(const Mesh& mesh, const SurfacePoint& p, const Value& value) {
    const auto vertices = weighted_vertices(mesh, p);
    if (vertices.size() == 1) return value(vertices[0].first);
    auto sum = vertices[0].second * value(vertices[0].first);
    for (std::size_t k = 1; k < vertices.size(); ++k) sum = sum + vertices[k].second * value(vertices[k].first);
    return sum;
}
/// The barycentric weights of the point in `face`, which must contain the point.
std::array<double, 3> in_face(const Mesh& mesh, const SurfacePoint& p, Index face);

/// The faces that contain the point.
std::vector<Face> faces_of(const Mesh& mesh, const SurfacePoint& p);
/// The smallest index of a face that contains both points; no_index if there is none.
Index shared_face(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b);
/// The edge that contains both points; no_index if there is none or if a point lies inside a face.
Index shared_edge(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b);
/// True if the point lies on the border of the mesh, at a vertex or on an edge.
bool is_on_border(const Mesh& mesh, const SurfacePoint& p);
/// The corner of the point's element with the largest weight.
Index nearest_vertex(const Mesh& mesh, const SurfacePoint& p);

}  // namespace ostraka
