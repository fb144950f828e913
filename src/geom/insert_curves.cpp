#include "ostraka/geom/insert_curves.h"

#include "geom/face_verdict.h"
#include "ostraka/geom/shortest_path.h"

#include <algorithm>
#include <map>
#include <optional>

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

std::vector<std::pair<Index, double>> left_area_fractions(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, int rings) {
    FaceCutter cutter(mesh, curves);
    // Pieces per face as directed pairs of vertices; a piece and its reverse cancel.
    std::map<Index, std::map<std::pair<Index, Index>, int>> pieces;
    for (std::size_t c = 0; c < curves.size(); ++c)
        for (std::size_t i = 0; i < curves[c].faces.size(); ++i) {
            const Index a = cutter.node_vertex()[c][i], b = cutter.node_vertex()[c][i + 1];
            if (a != b) pieces[curves[c].faces[i]][std::minmax(a, b)] += a < b ? 1 : -1;
        }
    std::map<Index, double> share_of;
    std::map<Index, FaceClassification> verdicts;
    for (const auto& [face, net] : pieces) {
        const FaceClassification verdict = classify_face(mesh, face, cutter, cutter.cut(face), net);
        if (!verdict.known) continue;
        verdicts.emplace(face, verdict);
        if (verdict.area > 0) share_of[face] = verdict.share;
    }
    // Rings of faces without curves: each face lies on the side of the face from which it was reached.
    std::vector<std::pair<Index, double>> ring;
    const auto reach = [&](Halfedge h, double share) {
        if (mesh.is_border(mesh.opposite(h))) return;
        const Index g = mesh.face(mesh.opposite(h));
        if (pieces.count(g) == 0 && share_of.emplace(g, share).second) ring.emplace_back(g, share);
    };
    for (const auto& [face, verdict] : verdicts) {
        Halfedge h = mesh.next(mesh.halfedge(Face(face)));  // from corner 0 to corner 1
        for (std::size_t k = 0; k < 3; ++k, h = mesh.next(h))
            if (verdict.beyond[k] >= 0) reach(h, verdict.beyond[k]);
    }
    for (int k = 1; k < rings; ++k) {
        std::vector<std::pair<Index, double>> last;
        std::swap(last, ring);
        for (const auto& [f, share] : last)
            for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(Face(f)), mesh)) reach(h, share);
    }
    return {share_of.begin(), share_of.end()};
}

}  // namespace ostraka
