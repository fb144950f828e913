#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "remesh/metric.h"
#include "remesh/property_carrier.h"
#include "remesh/subdivide.h"

#include <algorithm>

namespace ostraka {

namespace {

class Halver {
public:
    Halver(Mesh& mesh, RefineResult& result) : mesh_(mesh), result_(result), edges_(mesh), faces_(mesh) {}

    void halve(Edge e) {
        const Halfedge h = mesh_.halfedge(e, 0), o = mesh_.opposite(h);  // a -> b, b -> a; afterwards a -> m, m -> a
        const Vertex a = mesh_.source(h), b = mesh_.target(h);
        const Vertex m = mesh_.add_vertex(midway(mesh_.point(a), mesh_.point(b)));
        result_.parents.push_back({a, b});
        const Halfedge second_half = mesh_.add_edge(m, b), second_half_back = mesh_.opposite(second_half);  // m -> b, b -> m
        edges_.copy(e, mesh_.edge(second_half));
        result_.edge_origin.push_back(result_.edge_origin[e]);
        mesh_.set_target(h, m);
        if (mesh_.halfedge(b) == h) mesh_.set_halfedge(b, second_half);
        mesh_.set_halfedge(m, h);
        if (mesh_.is_border(h)) {
            mesh_.set_face(second_half, Mesh::null_face());
            mesh_.set_next(second_half, mesh_.next(h));
            mesh_.set_next(h, second_half);
        } else {
            const Halfedge next = mesh_.next(h), last = mesh_.prev(h);  // b -> c, c -> a
            const Halfedge cut = add_cut(m, mesh_.target(next));        // m -> c
            link_triangle(mesh_, mesh_.face(h), h, cut, last);
            link_triangle(mesh_, add_face(mesh_.face(h)), second_half, next, mesh_.opposite(cut));
        }
        if (mesh_.is_border(o)) {
            mesh_.set_face(second_half_back, Mesh::null_face());
            mesh_.set_next(mesh_.prev(o), second_half_back);
            mesh_.set_next(second_half_back, o);
            mesh_.set_halfedge(m, second_half_back);
        } else {
            const Halfedge next = mesh_.next(o), last = mesh_.prev(o);  // a -> d, d -> b
            const Halfedge cut = add_cut(m, mesh_.target(next));        // m -> d
            link_triangle(mesh_, mesh_.face(o), o, next, mesh_.opposite(cut));
            link_triangle(mesh_, add_face(mesh_.face(o)), second_half_back, cut, last);
        }
        ++result_.bisections;
    }

private:
    Halfedge add_cut(Vertex from, Vertex to) {
        result_.edge_origin.push_back(no_index);
        return mesh_.add_edge(from, to);
    }
    Face add_face(Face old) {
        const Face face = mesh_.add_face();
        faces_.copy(old, face);
        result_.face_origin.push_back(result_.face_origin[old]);
        return face;
    }

    Mesh& mesh_;
    RefineResult& result_;
    PropertyCarrier<Edge> edges_;
    PropertyCarrier<Face> faces_;
};

}  // namespace

void halve_longest_edges(Mesh& mesh, std::size_t vertices, RefineResult& result) {
    if (mesh.number_of_vertices() >= vertices) return;
    const std::size_t cuts = vertices - mesh.number_of_vertices();
    const auto added_vertices = static_cast<Index>(cuts);
    mesh.reserve(static_cast<Index>(vertices), static_cast<Index>(mesh.number_of_edges()) + 3 * added_vertices,
                 static_cast<Index>(mesh.number_of_faces()) + 2 * added_vertices);
    result.parents.reserve(result.parents.size() + cuts);
    result.edge_origin.reserve(mesh.number_of_edges() + 3 * cuts);
    result.face_origin.reserve(mesh.number_of_faces() + 2 * cuts);
    const Frame frame = make_frame(mesh);
    const auto squared_length = [&](Edge e) {
        return (frame.local(mesh.point(mesh.vertex(e, 0))) - frame.local(mesh.point(mesh.vertex(e, 1)))).squared_length();
    };
    // Halving a longest edge of length L creates edges of at most sqrt(3)/2 L: half of L, or the line from the midpoint to a
    // corner whose edges are not longer than L. So all edges longer than 0.867 L can be sorted once and halved in this order,
    // which is that of a priority queue.
    constexpr double min_ratio = 0.867 * 0.867;
    Halver halver(mesh, result);
    Progress progress("refine", cuts);
    std::vector<std::pair<double, Index>> longest;
    CancelCheck check;
    while (mesh.number_of_vertices() < vertices) {
        double greatest = 0;
        for (const Edge e : mesh.edges()) greatest = std::max(greatest, squared_length(e));
        if (!(greatest > 0)) fail_input("mesh", "has no edge of positive length to halve", "choose a mesh whose vertices differ");
        longest.clear();
        for (const Edge e : mesh.edges())
            if (const double length = squared_length(e); length >= min_ratio * greatest) longest.emplace_back(-length, e);
        const std::size_t remaining = vertices - mesh.number_of_vertices();
        if (longest.size() > remaining) {
            std::nth_element(longest.begin(), longest.begin() + static_cast<std::ptrdiff_t>(remaining), longest.end());
            longest.resize(remaining);
        }
        std::sort(longest.begin(), longest.end());
        for (const auto& [length, e] : longest) {
            check();
            halver.halve(Edge(e));
        }
        progress.advance(longest.size());
    }
}

}  // namespace ostraka
