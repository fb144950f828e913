#include "geom/face_cutter.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

namespace {
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
}  // namespace

FaceCutter::FaceCutter(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) : mesh_(mesh), curves_(curves) {
    for (const SurfaceCurve& curve : curves) {
        std::vector<Index>& vertices = node_vertex_.emplace_back();
        for (const SurfacePoint& p : curve.points) vertices.push_back(vertex_at(p));
    }
    for (auto& [edge, list] : on_edge_) std::sort(list.begin(), list.end());
    for (std::size_t c = 0; c < curves.size(); ++c)
        for (std::size_t i = 0; i < curves[c].faces.size(); ++i) {
            const Index a = node_vertex_[c][i], b = node_vertex_[c][i + 1];
            if (a == b || shared_edge(mesh_, curves[c].points[i], curves[c].points[i + 1]) != no_index) continue;
            cuts_[curves[c].faces[i]].segments.emplace_back(std::min(a, b), std::max(a, b));
        }
    // A face with a new vertex on an edge must be subdivided even if no curve traverses it.
    for (const auto& [edge, list] : on_edge_)
        for (const unsigned k : {0U, 1U})
            if (const Halfedge h = mesh_.halfedge(Edge(edge), k); !mesh_.is_border(h)) cuts_[mesh_.face(h)];
    for (auto& [face, cut] : cuts_) {
        std::sort(cut.segments.begin(), cut.segments.end());
        cut.segments.erase(std::unique(cut.segments.begin(), cut.segments.end()), cut.segments.end());
    }
}

std::vector<Index> FaceCutter::path(std::size_t curve) const {
    const SurfaceCurve& drawn = curves_[curve];
    if (drawn.points.empty()) return {};
    std::vector<Index> vertices{node_vertex_[curve].front()};
    for (std::size_t i = 0; i < drawn.faces.size(); ++i) {
        const Index a = node_vertex_[curve][i], b = node_vertex_[curve][i + 1];
        if (a == b) continue;
        std::vector<Index> between;
        bool forward = a < b;
        if (const Index edge = shared_edge(mesh_, drawn.points[i], drawn.points[i + 1]); edge != no_index) {
            const auto along = [&](const SurfacePoint& p) {
                if (p.is_on_edge()) return fraction_along(mesh_, Edge(edge), p);
                return p.vertex() == mesh_.source(mesh_.halfedge(Edge(edge), 0)) ? 0.0 : 1.0;
            };
            const double from = along(drawn.points[i]), to = along(drawn.points[i + 1]);
            forward = from < to;
            if (const auto found = on_edge_.find(edge); found != on_edge_.end())
                for (const auto& [fraction, v] : found->second)
                    if (fraction > std::min(from, to) && fraction < std::max(from, to) && v != a && v != b) between.push_back(v);
        } else if (const auto found = crossed_.find(std::minmax(a, b)); found != crossed_.end()) {
            between = found->second;
        }
        if (!forward) std::reverse(between.begin(), between.end());
        vertices.insert(vertices.end(), between.begin(), between.end());
        vertices.push_back(b);
    }
    return vertices;
}

std::vector<Index> FaceCutter::faces() const {
    std::vector<Index> list;
    for (const auto& [face, cut] : cuts_) list.push_back(face);
    return list;
}

Index FaceCutter::add_point(const SurfacePoint& p) {
    points_.push_back(p);
    positions_.push_back(position(mesh_, p));
    return static_cast<Index>(mesh_.number_of_vertices() + points_.size() - 1);
}

/// The vertex at a point of a curve: an old one, or a new one for the first of several equal points.
Index FaceCutter::vertex_at(const SurfacePoint& p) {
    constexpr double same = 1e-7;  // points closer than this fraction of the edge are merged
    if (!has_element(mesh_, p)) fail_input("curve", fmt::format("names {}, which does not exist", element_name(p)));
    if (p.is_vertex()) return p.element[0];
    if (p.is_on_edge()) {
        const Edge edge = edge_of(mesh_, p);
        const double fraction = fraction_along(mesh_, edge, p);
        const auto near = edge_vertex_.lower_bound({edge, fraction - same});
        if (near != edge_vertex_.end() && Edge(near->first.first) == edge && near->first.second <= fraction + same)
            return near->second;
        const Index v = add_point(p);
        edge_vertex_.emplace(std::pair(edge, fraction), v);
        on_edge_[edge].emplace_back(fraction, v);
        return v;
    }
    const Index face = p.element[0];
    const auto [entry, fresh] = face_vertex_.try_emplace({face, p.weights[1], p.weights[2]});
    if (fresh) {
        entry->second = add_point(p);
        cuts_[face].inner.push_back(entry->second);
    }
    return entry->second;
}

/// The boundary of a face with the vertices on its edges, counter-clockwise.
std::vector<Index> FaceCutter::border(Index face) const {
    std::vector<Index> vertex_path;
    Halfedge h = mesh_.next(mesh_.halfedge(Face(face)));
    for (int k = 0; k < 3; ++k, h = mesh_.next(h)) {
        vertex_path.push_back(mesh_.source(h));
        const auto found = on_edge_.find(mesh_.edge(h));
        if (found == on_edge_.end()) continue;
        const auto& list = found->second;
        if (mesh_.halfedge(mesh_.edge(h), 0) == h)
            for (const auto& [fraction, v] : list) vertex_path.push_back(v);
        else
            for (auto i = list.rbegin(); i != list.rend(); ++i) vertex_path.push_back(i->second);
    }
    return vertex_path;
}

/// The constrained triangulation of one face in its plane.
class FaceCutter::FaceTriangulation {
public:
    FaceTriangulation(FaceCutter& cutter, Index face)
        : cutter_(cutter), face_(face), corners_(corners(cutter.mesh_, Face(face))), origin_(cutter.mesh_.point(corners_[0])) {
        const Vector edge = cutter.mesh_.point(corners_[1]) - origin_;
        scale_ = std::sqrt(edge.squared_length());
        x_ = edge / scale_;
        y_ = CGAL::cross_product(area_vector(cutter.mesh_, Face(face)), x_);
        y_ = y_ / std::sqrt(y_.squared_length());
    }

    /// Triangulates the face with this boundary and, if `with_curves`, the segments of the curves. Returns false if rounding
    /// makes the boundary invalid.
    bool run(const Cut& cut, const std::vector<Index>& boundary, bool with_curves, std::vector<std::array<Index, 3>>& triangles) {
        for (const std::vector<Index>* vertices : {&boundary, &cut.inner})
            for (const Index v : *vertices)
                if (!insert(v)) return false;
        const std::size_t inserted = handles_.size();
        for (std::size_t i = 0; i < boundary.size(); ++i) {
            const Index v = boundary[i], w = boundary[(i + 1) % boundary.size()];
            rim_.emplace(std::min(v, w), std::max(v, w));
            triangulation_.insert_constraint(handles_[v], handles_[w]);
        }
        if (triangulation_.number_of_vertices() != inserted) return false;
        if (with_curves) {
            for (const auto& [v, w] : cut.segments)
                if (handles_.count(v) > 0 && handles_.count(w) > 0 && rim_.count({v, w}) == 0)
                    triangulation_.insert_constraint(handles_[v], handles_[w]);
            if (triangulation_.number_of_vertices() != inserted) add_crossings();
            for (const auto& [v, w] : cut.segments) note_crossings(v, w);
        }
        return collect(triangles);
    }

private:
    /// False if another vertex has the same position in the plane.
    bool insert(Index v) {
        const Vector d = cutter_.point(v) - origin_;
        const auto inserted = triangulation_.insert(Kernel::Point_2((d * x_) / scale_, (d * y_) / scale_));
        for (const auto& [other, other_handle] : handles_)
            if (other_handle == inserted) return false;
        inserted->info() = v;
        handles_[v] = inserted;
        return true;
    }

    /// Adds the vertices that crossings of curves have created.
    void add_crossings() {
        std::set<Triangulation::Vertex_handle> inserted;
        for (const auto& [v, handle] : handles_) inserted.insert(handle);
        std::vector<Triangulation::Vertex_handle> crossings;
        for (auto v = triangulation_.finite_vertices_begin(); v != triangulation_.finite_vertices_end(); ++v)
            if (inserted.count(v) == 0) crossings.push_back(v);
        std::sort(crossings.begin(), crossings.end(), [](auto v, auto w) { return v->point() < w->point(); });
        const Mesh& mesh = cutter_.mesh_;
        const auto& [a, b, c] = corners_;
        for (const auto v : crossings) {
            const Point place = origin_ + scale_ * (v->point().x() * x_ + v->point().y() * y_);
            const auto barycentric = nearest_barycentric(mesh.point(a), mesh.point(b), mesh.point(c), place);
            v->info() = cutter_.add_point(face_point(face_, barycentric));
            handles_[v->info()] = v;
        }
    }

    /// Records the vertices along a piece from v to w that is not an edge of the triangulation.
    void note_crossings(Index v, Index w) {
        const auto from = handles_.find(v), to = handles_.find(w);
        if (from == handles_.end() || to == handles_.end() || rim_.count({v, w}) > 0 ||
            triangulation_.is_edge(from->second, to->second))
            return;
        const Kernel::Point_2 p = from->second->point(), q = to->second->point();
        const Kernel::Vector_2 along = q - p;
        std::vector<std::pair<double, Index>> between;
        for (const auto& [other, other_handle] : handles_) {
            const Kernel::Vector_2 d = other_handle->point() - p;
            const double share = (d * along) / along.squared_length();
            if (other != v && other != w && share > 0 && share < 1 && (d - share * along).squared_length() < 1e-18)
                between.emplace_back(share, other);
        }
        std::sort(between.begin(), between.end());
        std::vector<Index>& crossed = cutter_.crossed_[{v, w}];
        crossed.clear();
        for (const auto& [share, other] : between) crossed.push_back(other);
    }

    [[nodiscard]] bool is_on_rim(Triangulation::Face_handle f, int i) const {
        const auto v = f->vertex(Triangulation::cw(i)), w = f->vertex(Triangulation::ccw(i));
        if (triangulation_.is_infinite(v) || triangulation_.is_infinite(w)) return false;
        return rim_.count(std::minmax(v->info(), w->info())) > 0;
    }

    /// The triangles inside the boundary: those that cannot be reached from outside without crossing it.
    bool collect(std::vector<std::array<Index, 3>>& triangles) const {
        std::set<Triangulation::Face_handle> outside;
        std::vector<Triangulation::Face_handle> stack{triangulation_.infinite_face()};
        outside.insert(stack.front());
        while (!stack.empty()) {
            const auto f = stack.back();
            stack.pop_back();
            for (int i = 0; i < 3; ++i)
                if (!is_on_rim(f, i) && outside.insert(f->neighbor(i)).second) stack.push_back(f->neighbor(i));
        }
        std::size_t rim_edges = 0;
        for (auto f = triangulation_.finite_faces_begin(); f != triangulation_.finite_faces_end(); ++f) {
            if (outside.count(f) > 0) continue;
            for (int i = 0; i < 3; ++i) rim_edges += is_on_rim(f, i) ? 1 : 0;
            triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
        }
        if (rim_edges != rim_.size() || triangles.empty()) return false;
        for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        std::sort(triangles.begin(), triangles.end());
        return true;
    }

    FaceCutter& cutter_;
    Index face_;
    std::array<Vertex, 3> corners_;
    Point origin_;
    double scale_ = 1;  ///< length of the first edge
    Vector x_, y_;      ///< axes of the plane
    Triangulation triangulation_;
    std::map<Index, Triangulation::Vertex_handle> handles_;
    std::set<std::pair<Index, Index>> rim_;  ///< edges of the boundary
};

std::vector<std::array<Index, 3>> FaceCutter::cut(Index face) {
    const std::vector<Index> vertex_path = border(face);
    const auto found = cuts_.find(face);
    const Cut cut = found == cuts_.end() ? Cut{} : found->second;
    std::vector<std::array<Index, 3>> triangles;
    if (area_vector(mesh_, Face(face)).squared_length() > 0) {
        const std::size_t points_before = points_.size();
        // First with the curves; if rounding makes the boundary invalid, with the boundary only: the curves then follow edges
        // nearby.
        for (const bool with_curves : {true, false}) {
            if (FaceTriangulation(*this, face).run(cut, vertex_path, with_curves, triangles)) return triangles;
            points_.resize(points_before);
            positions_.resize(points_before);
            triangles.clear();
        }
    }
    // A degenerate face has no plane for a triangulation: its boundary is split as a fan, which needs no geometry.
    if (!cut.inner.empty())
        throw Error(ErrorKind::failure, "face " + std::to_string(face), "cannot be cut: it has no area to speak of",
                    "repair the mesh first");
    for (std::size_t i = 1; i + 1 < vertex_path.size(); ++i)
        triangles.push_back({vertex_path[0], vertex_path[i], vertex_path[i + 1]});
    return triangles;
}

}  // namespace ostraka
