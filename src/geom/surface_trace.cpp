#include "ostraka/geom/surface_trace.h"

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

/// A way out of a face: a node on its border that `from` does not share an edge with.
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
        // From an edge there is one way on; from a vertex the faces of the last piece are not entered again.
        came_from = best_face;
        if (best->node.kind == SurfaceNode::Kind::vertex) came_from = Mesh::null_face();
    }
    return std::nullopt;
}

}  // namespace ostraka
