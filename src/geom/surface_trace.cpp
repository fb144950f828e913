#include "ostraka/geom/surface_trace.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

SurfaceNode surface_node(const Mesh& mesh, Vertex vertex) {
    SurfaceNode node;
    node.element = vertex;
    node.point = mesh.point(vertex);
    return node;
}

namespace {
SurfaceNode edge_node(const Mesh& mesh, Halfedge h, double along, double snap) {
    if (along < snap) return surface_node(mesh, mesh.source(h));
    if (along > 1 - snap) return surface_node(mesh, mesh.target(h));
    SurfaceNode node;
    node.kind = SurfaceNode::Kind::edge;
    const Edge e = mesh.edge(h);
    node.element = e;
    node.parameter = mesh.halfedge(e, 0) == h ? along : 1 - along;
    const Point &a = mesh.point(mesh.source(mesh.halfedge(e, 0))), &b = mesh.point(mesh.target(mesh.halfedge(e, 0)));
    node.point = a + node.parameter * (b - a);
    return node;
}

bool same(const SurfaceNode& a, const SurfaceNode& b) { return a.kind == b.kind && a.element == b.element && a.point == b.point; }

/// An exit from a face: a node on its boundary that has no common edge with `from`.
struct Exit {
    SurfaceNode node;
    double progress;
};
}  // namespace

std::vector<Face> faces_of(const Mesh& mesh, const SurfaceNode& node) {
    std::vector<Face> faces;
    const auto add = [&](Halfedge h) {
        if (!mesh.is_border(h)) faces.push_back(mesh.face(h));
    };
    switch (node.kind) {
        case SurfaceNode::Kind::face:
            faces.emplace_back(node.element);
            break;
        case SurfaceNode::Kind::edge:
            add(mesh.halfedge(Edge(node.element), 0));
            add(mesh.halfedge(Edge(node.element), 1));
            break;
        case SurfaceNode::Kind::vertex:
            if (!mesh.is_isolated(Vertex(node.element)))
                for (const Halfedge h : CGAL::halfedges_around_target(Vertex(node.element), mesh)) add(h);
    }
    return faces;
}

SurfaceNode surface_node(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric, double snap) {
    const auto vertices = corners(mesh, Face(face));
    int zeros = 0;
    for (const double b : barycentric) zeros += b < snap;
    if (zeros >= 2) {
        const auto largest = std::max_element(barycentric.begin(), barycentric.end()) - barycentric.begin();
        return surface_node(mesh, vertices[static_cast<std::size_t>(largest)]);
    }
    if (zeros == 1) {
        const auto zero =
            static_cast<std::size_t>(std::min_element(barycentric.begin(), barycentric.end()) - barycentric.begin());
        const std::size_t a = (zero + 1) % 3, b = (zero + 2) % 3;
        const Halfedge h = find_halfedge(mesh, vertices[a], vertices[b]);
        return edge_node(mesh, h, barycentric[b] / (barycentric[a] + barycentric[b]), snap);
    }
    SurfaceNode node;
    node.kind = SurfaceNode::Kind::face;
    node.element = face;
    node.barycentric = barycentric;
    node.point = point_at(mesh, face, barycentric);
    return node;
}

SurfacePlace place_of(const Mesh& mesh, const SurfaceNode& node) {
    SurfacePlace place;
    place.kind = node.kind;
    place.element[0] = node.element;
    if (node.kind == SurfaceNode::Kind::edge) {
        const Halfedge h = mesh.halfedge(Edge(node.element), 0);
        const Index a = mesh.source(h), b = mesh.target(h);
        place.element = {std::min(a, b), std::max(a, b)};
        place.weights[0] = a < b ? node.parameter : 1 - node.parameter;
    } else if (node.kind == SurfaceNode::Kind::face) {
        place.weights = {node.barycentric[1], node.barycentric[2]};
    }
    return place;
}

SurfaceNode node_at(const Mesh& mesh, const SurfacePlace& place) {
    const auto missing = [](const std::string& what) {
        fail_input("a place on the surface", "names " + what + ", which the mesh does not have",
                   "give the mesh that the place was made for");
    };
    const auto [first, second] = place.element;
    const auto [u, v] = place.weights;
    const auto outside = [](const std::string& what) {
        fail_input("a place on the surface", "has weights that are not within " + what, "correct or remove it");
    };
    SurfaceNode node;
    node.kind = place.kind;
    node.element = first;
    switch (place.kind) {
        case SurfaceNode::Kind::vertex:
            if (first >= mesh.number_of_vertices()) missing("vertex " + std::to_string(first));
            node.point = mesh.point(Vertex(first));
            break;
        case SurfaceNode::Kind::edge: {
            const std::string name = "an edge from vertex " + std::to_string(first) + " to vertex " + std::to_string(second);
            if (first >= mesh.number_of_vertices() || second >= mesh.number_of_vertices()) missing(name);
            const Halfedge h = find_halfedge(mesh, Vertex(first), Vertex(second));
            if (!h.is_valid()) missing(name);
            if (!(u > 0 && u < 1)) outside("the edge");
            node.element = mesh.edge(h);
            node.parameter = mesh.halfedge(mesh.edge(h), 0) == h ? u : 1 - u;
            const Point &a = mesh.point(Vertex(first)), &b = mesh.point(Vertex(second));
            node.point = a + u * (b - a);
            break;
        }
        case SurfaceNode::Kind::face:
            if (first >= mesh.number_of_faces()) missing("face " + std::to_string(first));
            if (!(u >= 0 && v >= 0 && u + v <= 1)) outside("the face");
            node.barycentric = {1 - u - v, u, v};
            node.point = point_at(mesh, first, node.barycentric);
    }
    return node;
}

Index common_face(const Mesh& mesh, const SurfaceNode& a, const SurfaceNode& b) {
    if (a.kind == SurfaceNode::Kind::face && b.kind == SurfaceNode::Kind::face)
        return a.element == b.element ? a.element : no_index;
    Index lowest = no_index;
    const std::vector<Face> others = faces_of(mesh, b);
    for (const Face f : faces_of(mesh, a))
        if (static_cast<Index>(f) < lowest && std::find(others.begin(), others.end(), f) != others.end()) lowest = f;
    return lowest;
}

Index common_edge(const Mesh& mesh, const SurfaceNode& a, const SurfaceNode& b) {
    using Kind = SurfaceNode::Kind;
    if (a.kind == Kind::face || b.kind == Kind::face) return no_index;
    if (a.kind == Kind::edge && b.kind == Kind::edge) return a.element == b.element ? a.element : no_index;
    if (a.kind == Kind::vertex && b.kind == Kind::vertex) {
        const Halfedge h = find_halfedge(mesh, Vertex(a.element), Vertex(b.element));
        return h.is_valid() ? static_cast<Index>(mesh.edge(h)) : no_index;
    }
    const SurfaceNode &vertex = a.kind == Kind::vertex ? a : b, &edge = a.kind == Kind::vertex ? b : a;
    const Halfedge h = mesh.halfedge(Edge(edge.element), 0);
    return Vertex(vertex.element) == mesh.source(h) || Vertex(vertex.element) == mesh.target(h) ? edge.element : no_index;
}

SurfaceCurve curve_through(const Mesh& mesh, const std::vector<SurfacePlace>& places) {
    SurfaceCurve curve;
    curve.nodes.reserve(places.size());
    curve.faces.reserve(places.size());
    for (const SurfacePlace& place : places) {
        curve.nodes.push_back(node_at(mesh, place));
        if (curve.nodes.size() == 1) continue;
        const Index face = common_face(mesh, curve.nodes[curve.nodes.size() - 2], curve.nodes.back());
        if (face == no_index)
            fail_input("a curve",
                       "its places " + std::to_string(curve.nodes.size() - 2) + " and " + std::to_string(curve.nodes.size() - 1) +
                           " lie in no common face",
                       "neighbours on a curve must share a face: add the places where it crosses edges");
        curve.faces.push_back(face);
    }
    return curve;
}

double SurfaceCurve::length() const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        sum += std::sqrt(CGAL::squared_distance(nodes[i].point, nodes[i + 1].point));
    return sum;
}

std::optional<SurfaceCurve> trace_line(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to, const Vector& up,
                                       double limit) {
    constexpr double snap = 1e-6;
    SurfaceCurve curve;
    curve.nodes.push_back(from);
    if (same(from, to)) return curve;
    const Vector along = to.point - from.point;
    Vector across = CGAL::cross_product(along, up);
    const double length = std::sqrt(across.squared_length());
    if (!(length > 0)) return std::nullopt;
    across = across / length;
    const auto side = [&](Vertex v) { return (mesh.point(v) - from.point) * across; };
    const std::vector<Face> goal_faces = faces_of(mesh, to);
    double travelled = 0;
    Face came_from = Mesh::null_face();
    for (int steps = 0; steps < 100000; ++steps) {
        const SurfaceNode here = curve.nodes.back();
        const std::vector<Face> around = faces_of(mesh, here);
        for (const Face f : around) {
            if (std::find(goal_faces.begin(), goal_faces.end(), f) == goal_faces.end()) continue;
            travelled += std::sqrt(CGAL::squared_distance(here.point, to.point));
            if (travelled > limit) return std::nullopt;
            curve.faces.push_back(f);
            curve.nodes.push_back(to);
            return curve;
        }
        std::optional<Exit> best;
        Face best_face = Mesh::null_face();
        for (const Face f : around) {
            if (f == came_from) continue;
            for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh)) {
                if (here.kind == SurfaceNode::Kind::edge && static_cast<Index>(mesh.edge(h)) == here.element) continue;
                if (here.kind == SurfaceNode::Kind::vertex &&
                    (static_cast<Index>(mesh.source(h)) == here.element || static_cast<Index>(mesh.target(h)) == here.element))
                    continue;
                const double a = side(mesh.source(h)), b = side(mesh.target(h));
                if ((a > 0) == (b > 0) && a != 0 && b != 0) continue;
                const double t = a == b ? 0.5 : std::clamp(a / (a - b), 0.0, 1.0);
                Exit exit{edge_node(mesh, h, t, snap), 0};
                exit.progress = (exit.node.point - here.point) * along;
                if (same(exit.node, here)) continue;
                if (curve.nodes.size() > 1 && same(exit.node, curve.nodes[curve.nodes.size() - 2])) continue;
                if (!best || exit.progress > best->progress) {
                    best = exit;
                    best_face = f;
                }
            }
        }
        if (!best) return std::nullopt;
        travelled += std::sqrt(CGAL::squared_distance(here.point, best->node.point));
        if (travelled > limit) return std::nullopt;
        curve.faces.push_back(best_face);
        curve.nodes.push_back(best->node);
        // Through an edge, the trace continues in the opposite face; at a vertex, all faces around it are candidates.
        came_from = best_face;
        if (best->node.kind == SurfaceNode::Kind::vertex) came_from = Mesh::null_face();
    }
    return std::nullopt;
}

}  // namespace ostraka
