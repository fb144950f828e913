#include "ostraka/remesh/insert_curves.h"

#include "ostraka/core/error.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace ostraka {

namespace {

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

/// What happens inside one face of the old mesh.
struct Cut {
    std::vector<Index> inner;                       ///< vertices strictly inside
    std::vector<std::pair<Index, Index>> segments;  ///< pieces of curves, by vertex
};

class Inserter {
public:
    Inserter(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) : mesh_(mesh), soup_(to_soup(mesh)) {
        place_nodes(curves);
        for (std::size_t c = 0; c < curves.size(); ++c)
            for (std::size_t i = 0; i < curves[c].faces.size(); ++i) {
                const Index a = result_.node_vertex[c][i], b = result_.node_vertex[c][i + 1];
                if (a != b) cuts_[curves[c].faces[i]].segments.emplace_back(std::min(a, b), std::max(a, b));
            }
        // A face whose edge got a vertex must be cut even if no curve runs through it.
        for (const auto& [edge, list] : on_edge_)
            for (const unsigned k : {0U, 1U})
                if (const Halfedge h = mesh_.halfedge(Edge(edge), k); !mesh_.is_border(h)) cuts_[mesh_.face(h)];
    }

    InsertedCurves run() {
        std::vector<std::array<Index, 3>> triangles;
        const std::size_t old_count = soup_.points.size();
        std::swap(triangles, soup_.triangles);
        soup_.points = std::move(points_);
        for (Index f = 0; f < triangles.size(); ++f) {
            const auto cut = cuts_.find(f);
            if (cut == cuts_.end()) {
                soup_.triangles.push_back(triangles[f]);
                result_.face_origin.push_back(f);
            } else {
                cut_face(f, cut->second);
            }
        }
        result_.new_vertices = soup_.points.size() - old_count;
        result_.mesh = build_mesh(soup_);
        return std::move(result_);
    }

private:
    Index add_point(const Point& p) {
        points_.push_back({p.x(), p.y(), p.z()});
        return static_cast<Index>(points_.size() - 1);
    }

    void place_nodes(const std::vector<SurfaceCurve>& curves) {
        points_ = soup_.points;
        std::map<std::tuple<Index, double>, Index> edge_vertex;
        std::map<std::tuple<Index, double, double>, Index> face_vertex;
        constexpr double same = 1e-7;  // nodes nearer than this share of the edge are one
        for (const SurfaceCurve& curve : curves) {
            auto& vertices = result_.node_vertex.emplace_back();
            for (const SurfaceNode& node : curve.nodes) {
                Index v = node.element;
                if (node.kind == SurfaceNode::Kind::vertex) {
                    if (v >= mesh_.number_of_vertices())
                        fail_input("curve", "names vertex " + std::to_string(v) + ", which does not exist");
                } else if (node.kind == SurfaceNode::Kind::edge) {
                    if (node.element >= mesh_.number_of_edges())
                        fail_input("curve", "names edge " + std::to_string(node.element) + ", which does not exist");
                    const auto near = edge_vertex.lower_bound({node.element, node.parameter - same});
                    if (near != edge_vertex.end() && std::get<0>(near->first) == node.element &&
                        std::get<1>(near->first) <= node.parameter + same) {
                        v = near->second;
                    } else {
                        v = add_point(node.point);
                        edge_vertex.emplace(std::make_tuple(node.element, node.parameter), v);
                        on_edge_[node.element].emplace_back(node.parameter, v);
                    }
                } else {
                    if (node.element >= mesh_.number_of_faces())
                        fail_input("curve", "names face " + std::to_string(node.element) + ", which does not exist");
                    const auto [entry, fresh] =
                        face_vertex.emplace(std::make_tuple(node.element, node.barycentric[1], node.barycentric[2]), 0);
                    if (fresh) {
                        entry->second = add_point(node.point);
                        cuts_[node.element].inner.push_back(entry->second);
                    }
                    v = entry->second;
                }
                vertices.push_back(v);
            }
        }
        for (auto& [edge, list] : on_edge_) std::sort(list.begin(), list.end());
    }

    /// The border of a face with the vertices on its edges, counter-clockwise.
    std::vector<Index> border(Index f) const {
        std::vector<Index> chain;
        Halfedge h = mesh_.next(mesh_.halfedge(Face(f)));
        for (int k = 0; k < 3; ++k, h = mesh_.next(h)) {
            chain.push_back(mesh_.source(h));
            const auto found = on_edge_.find(mesh_.edge(h));
            if (found == on_edge_.end()) continue;
            const auto& list = found->second;
            if (mesh_.halfedge(mesh_.edge(h), 0) == h)
                for (auto i = list.begin(); i != list.end(); ++i) chain.push_back(i->second);
            else
                for (auto i = list.rbegin(); i != list.rend(); ++i) chain.push_back(i->second);
        }
        return chain;
    }

    void cut_face(Index f, const Cut& cut) {
        const std::vector<Index> chain = border(f);
        const auto [a, b, c] = corners(mesh_, Face(f));
        const Vector normal = area_vector(mesh_, Face(f));
        if (!(normal.squared_length() > 0)) {
            fan(f, cut, chain);
            return;
        }
        const Point& origin = mesh_.point(a);
        const double scale = std::sqrt(CGAL::squared_distance(origin, mesh_.point(b)));
        const Vector x = (mesh_.point(b) - origin) / scale;
        Vector y = CGAL::cross_product(normal, x);
        y = y / std::sqrt(y.squared_length());
        const std::size_t points_before = soup_.points.size(), triangles_before = soup_.triangles.size();
        // With every curve first; where rounding spoils the border, with the border alone: the curves then follow edges nearby.
        for (const bool with_curves : {true, false}) {
            if (triangulate(f, cut, chain, origin, x, y, scale, with_curves)) return;
            soup_.points.resize(points_before);
            soup_.triangles.resize(triangles_before);
            result_.face_origin.resize(triangles_before);
        }
        fan(f, cut, chain);
    }

    /// A face without area has no plane to triangulate in: its border is cut as a fan, which needs no geometry.
    void fan(Index f, const Cut& cut, const std::vector<Index>& chain) {
        if (!cut.inner.empty())
            throw Error(ErrorKind::failure, "face " + std::to_string(f), "cannot be cut: it has no area to speak of",
                        "repair the mesh first");
        for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
            soup_.triangles.push_back({chain[0], chain[i], chain[i + 1]});
            result_.face_origin.push_back(f);
        }
    }

    bool triangulate(Index f, const Cut& cut, const std::vector<Index>& chain, const Point& origin, const Vector& x,
                     const Vector& y, double scale, bool with_curves) {
        Triangulation triangulation;
        std::map<Index, Triangulation::Vertex_handle> handle;
        const auto insert = [&](Index v) {
            const auto& p = soup_.points[v];
            const Vector d = Point(p[0], p[1], p[2]) - origin;
            const auto inserted = triangulation.insert(Kernel::Point_2((d * x) / scale, (d * y) / scale));
            if (handle.count(v) > 0) return true;
            for (const auto& [other, other_handle] : handle)
                if (other_handle == inserted) return false;  // two vertices at one place in the plane
            inserted->info() = v;
            handle[v] = inserted;
            return true;
        };
        for (const Index v : chain)
            if (!insert(v)) return false;
        for (const Index v : cut.inner)
            if (!insert(v)) return false;
        const std::size_t known = handle.size();
        std::set<std::pair<Index, Index>> rim;
        for (std::size_t i = 0; i < chain.size(); ++i) {
            const Index v = chain[i], w = chain[(i + 1) % chain.size()];
            rim.emplace(std::min(v, w), std::max(v, w));
            triangulation.insert_constraint(handle[v], handle[w]);
        }
        if (triangulation.number_of_vertices() != known) return false;
        if (with_curves)
            for (const auto& [v, w] : cut.segments)
                if (handle.count(v) > 0 && handle.count(w) > 0 && rim.count({v, w}) == 0)
                    triangulation.insert_constraint(handle[v], handle[w]);
        // Crossings of curves made new vertices.
        if (triangulation.number_of_vertices() != known) {
            std::set<Triangulation::Vertex_handle> old;
            for (const auto& [v, h] : handle) old.insert(h);
            std::vector<Triangulation::Vertex_handle> fresh;
            for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v)
                if (old.count(v) == 0) fresh.push_back(v);
            std::sort(fresh.begin(), fresh.end(), [](auto v, auto w) { return v->point() < w->point(); });
            for (const auto v : fresh) {
                const Point p = origin + scale * (v->point().x() * x + v->point().y() * y);
                soup_.points.push_back({p.x(), p.y(), p.z()});
                v->info() = static_cast<Index>(soup_.points.size() - 1);
            }
        }
        // Faces of the triangulation within the rim: everything not reachable from outside without crossing it.
        std::set<Triangulation::Face_handle> outside;
        std::vector<Triangulation::Face_handle> stack{triangulation.infinite_face()};
        outside.insert(stack.front());
        const auto on_rim = [&](Triangulation::Face_handle face, int i) {
            const auto v = face->vertex(Triangulation::cw(i)), w = face->vertex(Triangulation::ccw(i));
            if (triangulation.is_infinite(v) || triangulation.is_infinite(w)) return false;
            return rim.count({std::min(v->info(), w->info()), std::max(v->info(), w->info())}) > 0;
        };
        while (!stack.empty()) {
            const auto face = stack.back();
            stack.pop_back();
            for (int i = 0; i < 3; ++i)
                if (!on_rim(face, i) && outside.insert(face->neighbor(i)).second) stack.push_back(face->neighbor(i));
        }
        std::size_t rim_edges = 0;
        std::vector<std::array<Index, 3>> triangles;
        for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end(); ++face) {
            if (outside.count(face) > 0) continue;
            for (int i = 0; i < 3; ++i) rim_edges += on_rim(face, i) ? 1 : 0;
            triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
        }
        if (rim_edges != rim.size() || triangles.empty()) return false;
        for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        std::sort(triangles.begin(), triangles.end());
        for (const auto& t : triangles) {
            soup_.triangles.push_back(t);
            result_.face_origin.push_back(f);
        }
        return true;
    }

    const Mesh& mesh_;
    TriangleSoup soup_;
    std::vector<std::array<double, 3>> points_;
    std::map<Index, std::vector<std::pair<double, Index>>> on_edge_;  ///< vertices on an edge, by parameter
    std::map<Index, Cut> cuts_;
    InsertedCurves result_;
};

}  // namespace

InsertedCurves insert_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) { return Inserter(mesh, curves).run(); }

}  // namespace ostraka
