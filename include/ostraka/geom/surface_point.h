// Points on the surface of a mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <array>
#include <compare>
#include <string>
#include <tuple>
#include <vector>

namespace ostraka {

/// A point on the surface, given by the element that contains it and weights in it, without coordinates: it stays on its element
/// when vertices move (compare SurfacePoint of geometry-central, Sharp et al. 2019). Elements are named by vertices and faces,
/// as in files, so that a point does not depend on the numbers of edges.
struct SurfacePoint {
    enum class Kind : std::uint8_t { vertex, edge, face };
    Kind kind = Kind::vertex;
    std::array<Index, 2> element{no_index, no_index};  ///< the vertex; the ends of the edge, in either order; the face
    std::array<double, 3> weights{1, 0, 0};  ///< weights of the vertex, of both ends, or of corners(mesh, face); their sum is one

    [[nodiscard]] bool is_vertex() const { return kind == Kind::vertex; }
    [[nodiscard]] bool is_on_edge() const { return kind == Kind::edge; }
    [[nodiscard]] bool is_in_face() const { return kind == Kind::face; }
    [[nodiscard]] Vertex vertex() const { return Vertex(element[0]); }
    [[nodiscard]] Face face() const { return Face(element[0]); }

    bool operator==(const SurfacePoint&) const = default;
    /// By element, then by the weights after the first, which follows from them.
    std::partial_ordering operator<=>(const SurfacePoint& other) const {
        return std::tie(kind, element, weights[1], weights[2], weights[0]) <=>
               std::tie(other.kind, other.element, other.weights[1], other.weights[2], other.weights[0]);
    }
};

SurfacePoint vertex_point(Index vertex);
/// At this fraction of the way from one end of an edge to the other.
SurfacePoint edge_point(Index from, Index to, double fraction);
/// The same with the lower end first.
SurfacePoint ordered_edge_point(Index from, Index to, double fraction);
SurfacePoint face_point(Index face, const std::array<double, 3>& weights);
/// The point of a face with these weights. Weights below `snap` are set to zero, so that a point near an edge or a vertex is
/// placed on it.
SurfacePoint surface_point(const Mesh& mesh, Index face, const std::array<double, 3>& weights, double snap = 1e-6);
/// The same on an edge.
SurfacePoint surface_point(const Mesh& mesh, Halfedge halfedge, double fraction, double snap = 1e-6);

/// The form in which annotations store the point, equal for equal points: the lower end of an edge first; the first weight
/// computed from the others.
SurfacePoint stored_point(const Mesh& mesh, const SurfacePoint& p);

/// "vertex 3", "the edge from vertex 1 to vertex 2", "face 4".
std::string element_name(const SurfacePoint& p);
/// Whether the mesh has the element.
bool has_element(const Mesh& mesh, const SurfacePoint& p);
/// Throws Error (input) if the mesh does not have the element or if the weights lie outside it.
void check_surface_point(const Mesh& mesh, const SurfacePoint& p);

/// The coordinates.
Point position(const Mesh& mesh, const SurfacePoint& p);
std::vector<Point> positions(const Mesh& mesh, const std::vector<SurfacePoint>& points);
/// True for points on the same element with the same coordinates.
bool same_point(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b);

/// The edge of a point on an edge.
Edge edge_of(const Mesh& mesh, const SurfacePoint& p);
/// The fraction of a point on an edge along halfedge(edge, 0).
double fraction_along(const Mesh& mesh, Edge edge, const SurfacePoint& p);

/// The vertices of the point's element with their weights: one, two or three. Those of an edge are the source and the target of
/// halfedge(edge, 0), so that values are added up in the same order from both faces.
std::vector<std::pair<Vertex, double>> weighted_vertices(const Mesh& mesh, const SurfacePoint& p);
/// The value at the point of a function that is linear in each face; `value(vertex)`: at the vertices.
template <class Value>
auto interpolate(const Mesh& mesh, const SurfacePoint& p, const Value& value) {
    const auto vertices = weighted_vertices(mesh, p);
    if (vertices.size() == 1) return value(vertices[0].first);
    auto sum = vertices[0].second * value(vertices[0].first);
    for (std::size_t k = 1; k < vertices.size(); ++k) sum = sum + vertices[k].second * value(vertices[k].first);
    return sum;
}
/// The weights of the point in one of its faces.
std::array<double, 3> in_face(const Mesh& mesh, const SurfacePoint& p, Index face);

/// The faces that contain the point.
std::vector<Face> faces_of(const Mesh& mesh, const SurfacePoint& p);
/// The lowest face that contains both points; no_index if there is none.
Index shared_face(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b);
/// The edge that contains both points; no_index if there is none or if a point lies inside a face.
Index shared_edge(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b);
/// Whether the point lies on the border of the mesh, as a vertex or on an edge.
bool is_on_border(const Mesh& mesh, const SurfacePoint& p);
/// The corner of the point's element with the largest weight.
Index nearest_vertex(const Mesh& mesh, const SurfacePoint& p);

}  // namespace ostraka
