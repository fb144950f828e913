#include "ostraka/geom/insert_curves.h"

#include "face_cutter.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/shortest_path.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace ostraka {

InsertedCurves insert_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) {
    FaceCutter cutter(mesh, curves);
    InsertedCurves result;
    result.node_vertex = cutter.node_vertex();
    TriangleSoup soup = to_soup(mesh);
    std::vector<std::array<Index, 3>> old;
    std::swap(old, soup.triangles);
    soup.triangles.reserve(old.size());
    result.face_origin.reserve(old.size());
    const std::vector<Index> faces = cutter.faces();
    auto next = faces.begin();
    for (Index f = 0; f < old.size(); ++f) {
        if (next == faces.end() || *next != f) {
            soup.triangles.push_back(old[f]);
            result.face_origin.push_back(f);
            continue;
        }
        ++next;
        for (const auto& triangle : cutter.cut(f)) {
            soup.triangles.push_back(triangle);
            result.face_origin.push_back(f);
        }
    }
    result.new_points = cutter.new_points();
    for (const Point& p : cutter.new_positions()) soup.points.push_back({p.x(), p.y(), p.z()});
    result.mesh = build_mesh(soup);
    for (const auto& [edge, list] : cutter.on_edge())
        for (const auto& [parameter, v] : list) result.on_edge[edge].push_back(v);
    std::optional<PathSearch> search;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        std::vector<Index>& path = result.paths.emplace_back();
        for (const Index v : cutter.path(c)) {
            if (!path.empty() && !find_halfedge(result.mesh, Vertex(path.back()), Vertex(v)).is_valid()) {
                // Because of rounding, this piece is not an edge: it follows nearby edges instead.
                if (!search) search.emplace(result.mesh);
                const std::vector<Index> way = search->find(Vertex(path.back()), Vertex(v), {});
                if (way.size() > 2) path.insert(path.end(), way.begin() + 1, way.end() - 1);
            }
            path.push_back(v);
        }
    }
    return result;
}

namespace {

/// Fraction of the area of a face to the left of the directed pieces; negative if no piece is a boundary in it. `whole_edges`
/// receives, for each old edge without a curve, whether the adjacent face lies to the left (1) or to the right (0).
double left_share(const FaceCutter& cutter, const std::vector<std::array<Index, 3>>& triangles,
                  const std::map<std::pair<Index, Index>, int>& net, const std::array<Vertex, 3>& old_corners,
                  std::vector<std::tuple<Index, Index, double>>& whole_edges) {
    enum { unknown, left, right };
    std::vector<int> side(triangles.size(), unknown);
    std::map<std::pair<Index, Index>, std::size_t> owner;  // directed edge -> triangle on its left
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) owner[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    const auto weight = [&](Index a, Index b) {
        const auto found = net.find(std::minmax(a, b));
        return found == net.end() ? 0 : a < b ? found->second : -found->second;
    };
    std::vector<std::size_t> stack;
    for (const auto& [edge, t] : owner) {
        const int w = weight(edge.first, edge.second);
        if (w == 0 || side[t] != unknown) continue;
        side[t] = w > 0 ? left : right;
        stack.push_back(t);
    }
    if (stack.empty()) return -1;
    CancelCheck check;
    while (!stack.empty()) {
        check();
        const std::size_t t = stack.back();
        stack.pop_back();
        for (int k = 0; k < 3; ++k) {
            const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            const auto other = owner.find({b, a});
            if (other == owner.end() || side[other->second] != unknown || weight(a, b) != 0) continue;
            side[other->second] = side[t];
            stack.push_back(other->second);
        }
    }
    for (int k = 0; k < 3; ++k) {
        const Index a = old_corners[k], b = old_corners[(k + 1) % 3];
        const auto found = owner.find({a, b});
        if (found == owner.end() || side[found->second] == unknown) continue;
        const bool turned = weight(a, b) != 0;  // the outline follows the edge: the adjacent face lies on the other side
        whole_edges.emplace_back(a, b, (side[found->second] == left) != turned ? 1.0 : 0.0);
    }
    double sum = 0, inside = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const double area =
            std::sqrt(CGAL::cross_product(cutter.point(b) - cutter.point(a), cutter.point(c) - cutter.point(a)).squared_length());
        sum += area;
        if (side[t] == left) inside += area;
    }
    return sum > 0 ? inside / sum : -1;
}

}  // namespace

std::vector<std::pair<Index, double>> left_shares(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, int rings) {
    FaceCutter cutter(mesh, curves);
    // Pieces per face as directed pairs of vertices; a piece and its reverse cancel.
    std::map<Index, std::map<std::pair<Index, Index>, int>> pieces;
    for (std::size_t c = 0; c < curves.size(); ++c)
        for (std::size_t i = 0; i < curves[c].faces.size(); ++i) {
            const Index a = cutter.node_vertex()[c][i], b = cutter.node_vertex()[c][i + 1];
            if (a != b) pieces[curves[c].faces[i]][std::minmax(a, b)] += a < b ? 1 : -1;
        }
    std::map<Index, double> share_of;
    std::vector<std::tuple<Index, Index, double>> whole_edges;
    for (const auto& [face, net] : pieces) {
        const double share = left_share(cutter, cutter.cut(face), net, corners(mesh, Face(face)), whole_edges);
        if (share >= 0) share_of[face] = share;
    }
    // Rings of faces without curves: each face lies on the side of the face from which it was reached.
    std::vector<std::pair<Index, double>> ring;
    const auto reach = [&](Halfedge h, double share) {
        if (mesh.is_border(mesh.opposite(h))) return;
        const Index g = mesh.face(mesh.opposite(h));
        if (pieces.count(g) == 0 && share_of.emplace(g, share).second) ring.emplace_back(g, share);
    };
    for (const auto& [a, b, share] : whole_edges) reach(find_halfedge(mesh, Vertex(a), Vertex(b)), share);
    for (int k = 1; k < rings; ++k) {
        std::vector<std::pair<Index, double>> last;
        std::swap(last, ring);
        for (const auto& [f, share] : last)
            for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(Face(f)), mesh)) reach(h, share);
    }
    return {share_of.begin(), share_of.end()};
}

}  // namespace ostraka
