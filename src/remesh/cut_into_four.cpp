#include "ostraka/core/angles.h"
#include "remesh/collapse.h"
#include "remesh/property_carrier.h"
#include "remesh/subdivide.h"

#include <cmath>

namespace ostraka {

namespace {

Vector position(const Mesh& mesh, Vertex v) { return mesh.point(v) - CGAL::ORIGIN; }

/// Loop 1987: 3/8, 3/8, 1/8, 1/8 inside, the midpoint on the border.
Point loop_edge_point(const Mesh& mesh, Edge e) {
    const Halfedge h = mesh.halfedge(e, 0), o = mesh.opposite(h);
    if (mesh.is_border(e)) return midway(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
    return CGAL::ORIGIN + (3.0 / 8) * (position(mesh, mesh.source(h)) + position(mesh, mesh.target(h))) +
           (1.0 / 8) * (position(mesh, mesh.target(mesh.next(h))) + position(mesh, mesh.target(mesh.next(o))));
}

/// Loop 1987 inside; the cubic spline (1/8, 3/4, 1/8) on the border.
Point loop_vertex_point(const Mesh& mesh, Vertex v) {
    if (mesh.is_isolated(v)) return mesh.point(v);
    if (mesh.is_border(v)) {
        Vector sum(0, 0, 0);
        for_each_incoming(mesh, v, [&](Halfedge h) {
            if (mesh.is_border(mesh.edge(h))) sum += position(mesh, mesh.source(h));
        });
        return CGAL::ORIGIN + 0.75 * position(mesh, v) + 0.125 * sum;
    }
    Vector sum(0, 0, 0);
    double n = 0;
    for_each_incoming(mesh, v, [&](Halfedge h) {
        sum += position(mesh, mesh.source(h));
        n += 1;
    });
    const double cosine = 3.0 / 8 + std::cos(2 * pi / n) / 4;
    const double weight = 5.0 / 8 - cosine * cosine;
    return CGAL::ORIGIN + (1 - weight) * position(mesh, v) + (weight / n) * sum;
}

}  // namespace

void cut_into_four(Mesh& mesh, bool smooth, RefineResult& result) {
    const auto V = static_cast<Index>(mesh.number_of_vertices()), E = static_cast<Index>(mesh.number_of_edges()),
               F = static_cast<Index>(mesh.number_of_faces());
    std::vector<Point> smoothed;
    if (smooth) {
        smoothed.reserve(V);
        for (const Vertex v : mesh.vertices()) smoothed.push_back(loop_vertex_point(mesh, v));
    }
    std::vector<std::pair<Halfedge, Halfedge>> border;  // halfedge, next halfedge
    for (const Halfedge h : mesh.halfedges())
        if (mesh.is_border(h)) border.emplace_back(h, mesh.next(h));

    mesh.reserve(V + E, 2 * E + 3 * F, 4 * F);
    result.parents.reserve(result.parents.size() + E);
    for (Index e = 0; e < E; ++e) {
        const Vertex a = mesh.vertex(Edge(e), 0), b = mesh.vertex(Edge(e), 1);
        mesh.add_vertex(smooth ? loop_edge_point(mesh, Edge(e)) : midway(mesh.point(a), mesh.point(b)));
        result.parents.push_back({a, b});
    }
    for (Index v = 0; v < smoothed.size(); ++v) mesh.point(Vertex(v)) = smoothed[v];
    for (Index e = E; e < 2 * E + 3 * F; ++e) mesh.add_edge(Vertex(0), Vertex(1));  // their ends are set below
    for (Index f = F; f < 4 * F; ++f) mesh.add_face();

    // Halfedge 2 e ends at the midpoint of its edge, halfedge 2 (E + e) starts there; vice versa on the opposite side.
    const auto first = [E](Halfedge h) { return h % 2 == 0 ? h : Halfedge(h + 2 * E); };
    const auto second = [E](Halfedge h) { return h % 2 == 0 ? Halfedge(h + 2 * E) : h; };
    for (Index f = 0; f < F; ++f) {
        std::array<Halfedge, 3> h;
        h[0] = mesh.halfedge(Face(f)), h[1] = mesh.next(h[0]), h[2] = mesh.next(h[1]);
        std::array<Halfedge, 3> inner;  // from the midpoint of h[k] to that of h[k - 1], in their common corner
        for (Index k = 0; k < 3; ++k) inner[k] = Halfedge(2 * (2 * E + 3 * f + k));
        for (Index k = 0; k < 3; ++k) {
            const Halfedge previous = h[(k + 2) % 3];
            mesh.set_target(inner[k], Vertex(V + previous / 2));
            mesh.set_target(mesh.opposite(inner[k]), Vertex(V + h[k] / 2));
            link_triangle(mesh, Face(F + 3 * f + k), inner[k], second(previous), first(h[k]));
        }
        link_triangle(mesh, Face(f), mesh.opposite(inner[1]), mesh.opposite(inner[2]), mesh.opposite(inner[0]));
    }
    for (const auto& [h, next] : border) {
        mesh.set_face(first(h), Mesh::null_face());
        mesh.set_face(second(h), Mesh::null_face());
        mesh.set_next(first(h), second(h));
        mesh.set_next(second(h), first(next));
    }
    for (Index v = 0; v < V; ++v)
        if (!mesh.is_isolated(Vertex(v))) mesh.set_halfedge(Vertex(v), second(mesh.halfedge(Vertex(v))));
    for (Index e = 0; e < E; ++e) {
        const Halfedge h = mesh.halfedge(Edge(e), 0), g = mesh.halfedge(Edge(E + e), 0);
        const Vertex m(V + e), b = mesh.target(h);
        mesh.set_target(h, m);
        mesh.set_target(g, b);
        mesh.set_target(mesh.opposite(g), m);
        mesh.set_halfedge(m, mesh.is_border(mesh.opposite(g)) ? mesh.opposite(g) : h);
    }

    const PropertyCarrier<Edge> edges(mesh);
    const PropertyCarrier<Face> faces(mesh);
    result.edge_origin.resize(2 * E + 3 * F, no_index);
    result.face_origin.resize(4 * F);
    for (Index e = 0; e < E; ++e) {
        edges.copy(Edge(e), Edge(E + e));
        result.edge_origin[E + e] = result.edge_origin[e];
    }
    for (Index f = 0; f < F; ++f)
        for (Index k = 0; k < 3; ++k) {
            faces.copy(Face(f), Face(F + 3 * f + k));
            result.face_origin[F + 3 * f + k] = result.face_origin[f];
        }
    ++result.levels;
}

}  // namespace ostraka
