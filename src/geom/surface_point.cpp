#include "ostraka/geom/surface_point.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

SurfacePoint vertex_point(Index vertex) { return {SurfacePoint::Kind::vertex, {vertex, no_index}, {1, 0, 0}}; }

SurfacePoint edge_point(Index from, Index to, double fraction) {
    return {SurfacePoint::Kind::edge, {from, to}, {1 - fraction, fraction, 0}};
}

SurfacePoint ordered_edge_point(Index from, Index to, double fraction) {
    return from < to ? edge_point(from, to, fraction) : edge_point(to, from, 1 - fraction);
}

SurfacePoint face_point(Index face, const std::array<double, 3>& weights) {
    return {SurfacePoint::Kind::face, {face, no_index}, weights};
}

SurfacePoint surface_point(const Mesh& mesh, Halfedge halfedge, double fraction, double snap) {
    if (fraction < snap) return vertex_point(mesh.source(halfedge));
    if (fraction > 1 - snap) return vertex_point(mesh.target(halfedge));
    const Halfedge first = mesh.halfedge(mesh.edge(halfedge), 0);
    return edge_point(mesh.source(first), mesh.target(first), first == halfedge ? fraction : 1 - fraction);
}

SurfacePoint surface_point(const Mesh& mesh, Index face, const std::array<double, 3>& weights, double snap) {
    const auto vertices = corners(mesh, Face(face));
    const auto zeros = std::count_if(weights.begin(), weights.end(), [&](double weight) { return weight < snap; });
    if (zeros >= 2) {
        const auto largest = std::max_element(weights.begin(), weights.end()) - weights.begin();
        return vertex_point(vertices[static_cast<std::size_t>(largest)]);
    }
    if (zeros == 0) return face_point(face, weights);
    const auto zero = static_cast<std::size_t>(std::min_element(weights.begin(), weights.end()) - weights.begin());
    const std::size_t a = (zero + 1) % 3, b = (zero + 2) % 3;
    return surface_point(mesh, find_halfedge(mesh, vertices[a], vertices[b]), weights[b] / (weights[a] + weights[b]), snap);
}

SurfacePoint stored_point(const Mesh& mesh, const SurfacePoint& p) {
    switch (p.kind) {
        case SurfacePoint::Kind::vertex:
            return p;
        case SurfacePoint::Kind::edge: {
            const Halfedge h = mesh.halfedge(edge_of(mesh, p), 0);
            return ordered_edge_point(mesh.source(h), mesh.target(h), fraction_along(mesh, mesh.edge(h), p));
        }
        default:
            return face_point(p.face(), {1 - p.weights[1] - p.weights[2], p.weights[1], p.weights[2]});
    }
}

std::string element_name(const SurfacePoint& p) {
    if (p.is_on_edge()) return fmt::format("the edge from vertex {} to vertex {}", p.element[0], p.element[1]);
    return fmt::format("{} {}", p.is_vertex() ? "vertex" : "face", p.element[0]);
}

bool has_element(const Mesh& mesh, const SurfacePoint& p) {
    if (p.is_in_face()) return p.element[0] < mesh.number_of_faces();
    if (p.element[0] >= mesh.number_of_vertices()) return false;
    return p.is_vertex() || (p.element[1] < mesh.number_of_vertices() &&
                             find_halfedge(mesh, Vertex(p.element[0]), Vertex(p.element[1])).is_valid());
}

void check_surface_point(const Mesh& mesh, const SurfacePoint& p) {
    if (!has_element(mesh, p))
        fail_input("a place on the surface", fmt::format("names {}, which the mesh does not have", element_name(p)),
                   "give the mesh that the place was made for");
    const auto [rest, u, v] = p.weights;
    const bool within = p.is_vertex() || (p.is_on_edge() ? u > 0 && u < 1 : u >= 0 && v >= 0 && u + v <= 1);
    if (!within)
        fail_input("a place on the surface",
                   fmt::format("has weights that are not within the {}", p.is_on_edge() ? "edge" : "face"),
                   "correct or remove it");
}

Point position(const Mesh& mesh, const SurfacePoint& p) {
    if (p.is_vertex()) return mesh.point(p.vertex());
    if (p.is_in_face()) return point_at(mesh, p.element[0], p.weights);
    const Point &a = mesh.point(Vertex(p.element[0])), &b = mesh.point(Vertex(p.element[1]));
    return a + p.weights[1] * (b - a);
}

std::vector<Point> positions(const Mesh& mesh, const std::vector<SurfacePoint>& points) {
    std::vector<Point> coordinates;
    coordinates.reserve(points.size());
    for (const SurfacePoint& p : points) coordinates.push_back(position(mesh, p));
    return coordinates;
}

namespace {
bool on_one_edge(const SurfacePoint& a, const SurfacePoint& b) {
    return a.element == b.element || (a.element[0] == b.element[1] && a.element[1] == b.element[0]);
}
}  // namespace

bool same_point(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b) {
    if (a.kind != b.kind) return false;
    if (a.is_on_edge() ? !on_one_edge(a, b) : a.element[0] != b.element[0]) return false;
    return a.is_vertex() || position(mesh, a) == position(mesh, b);
}

Edge edge_of(const Mesh& mesh, const SurfacePoint& p) {
    return mesh.edge(find_halfedge(mesh, Vertex(p.element[0]), Vertex(p.element[1])));
}

double fraction_along(const Mesh& mesh, Edge edge, const SurfacePoint& p) {
    return p.vertex() == mesh.source(mesh.halfedge(edge, 0)) ? p.weights[1] : p.weights[0];
}

std::vector<std::pair<Vertex, double>> weighted_vertices(const Mesh& mesh, const SurfacePoint& p) {
    if (p.is_vertex()) return {{p.vertex(), 1.0}};
    if (p.is_on_edge()) {
        const Halfedge h = mesh.halfedge(edge_of(mesh, p), 0);
        const double fraction = fraction_along(mesh, mesh.edge(h), p);
        return {{mesh.source(h), 1 - fraction}, {mesh.target(h), fraction}};
    }
    const auto [a, b, c] = corners(mesh, p.face());
    return {{a, p.weights[0]}, {b, p.weights[1]}, {c, p.weights[2]}};
}

std::array<double, 3> in_face(const Mesh& mesh, const SurfacePoint& p, Index face) {
    if (p.is_in_face()) return p.weights;
    std::array<double, 3> weights{0, 0, 0};
    const auto corner = corners(mesh, Face(face));
    for (const auto& [vertex, weight] : weighted_vertices(mesh, p))
        for (std::size_t k = 0; k < 3; ++k)
            if (corner[k] == vertex) weights[k] = weight;
    return weights;
}

std::vector<Face> faces_of(const Mesh& mesh, const SurfacePoint& p) {
    if (p.is_in_face()) return {p.face()};
    std::vector<Face> faces;
    const auto add = [&](Halfedge h) {
        if (!mesh.is_border(h)) faces.push_back(mesh.face(h));
    };
    if (p.is_on_edge()) {
        const Edge edge = edge_of(mesh, p);
        add(mesh.halfedge(edge, 0));
        add(mesh.halfedge(edge, 1));
    } else if (!mesh.is_isolated(p.vertex())) {
        for (const Halfedge h : CGAL::halfedges_around_target(p.vertex(), mesh)) add(h);
    }
    return faces;
}

Index shared_face(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b) {
    if (a.is_in_face() && b.is_in_face()) return a.element[0] == b.element[0] ? a.element[0] : no_index;
    Index lowest = no_index;
    const std::vector<Face> others = faces_of(mesh, b);
    for (const Face f : faces_of(mesh, a))
        if (static_cast<Index>(f) < lowest && std::find(others.begin(), others.end(), f) != others.end()) lowest = f;
    return lowest;
}

Index shared_edge(const Mesh& mesh, const SurfacePoint& a, const SurfacePoint& b) {
    if (a.is_in_face() || b.is_in_face()) return no_index;
    if (a.is_vertex() && b.is_vertex()) {
        const Halfedge h = find_halfedge(mesh, a.vertex(), b.vertex());
        return h.is_valid() ? static_cast<Index>(mesh.edge(h)) : no_index;
    }
    if (a.kind == b.kind) return on_one_edge(a, b) ? static_cast<Index>(edge_of(mesh, a)) : no_index;
    const SurfacePoint &vertex = a.is_vertex() ? a : b, &edge = a.is_vertex() ? b : a;
    const bool is_end = vertex.element[0] == edge.element[0] || vertex.element[0] == edge.element[1];
    return is_end ? static_cast<Index>(edge_of(mesh, edge)) : no_index;
}

bool is_on_border(const Mesh& mesh, const SurfacePoint& p) {
    if (p.is_vertex()) return mesh.is_border(p.vertex());
    return p.is_on_edge() && mesh.is_border(edge_of(mesh, p));
}

Index nearest_vertex(const Mesh& mesh, const SurfacePoint& p) {
    if (p.is_vertex()) return p.element[0];
    if (p.is_on_edge()) return p.element[p.weights[1] <= 0.5 ? 0 : 1];
    const auto corner = corners(mesh, p.face());
    const auto [w, u, v] = p.weights;
    return corner[w >= u && w >= v ? 0 : u >= v ? 1 : 2];
}

}  // namespace ostraka
