#include "face_cutter.h"

#include "ostraka/core/error.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace ostraka {

namespace {
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
}  // namespace

FaceCutter::FaceCutter(const Mesh& mesh, const std::vector<SurfaceCurve>& curves) : mesh_(mesh), curves_(curves) {
    place_nodes(curves);
    for (std::size_t c = 0; c < curves.size(); ++c)
        for (std::size_t i = 0; i < curves[c].faces.size(); ++i) {
            const Index a = node_vertex_[c][i], b = node_vertex_[c][i + 1];
            if (a == b || common_edge(mesh_, curves[c].nodes[i], curves[c].nodes[i + 1]) != no_index) continue;
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
    if (drawn.nodes.empty()) return {};
    std::vector<Index> vertices{node_vertex_[curve].front()};
    for (std::size_t i = 0; i < drawn.faces.size(); ++i) {
        const Index a = node_vertex_[curve][i], b = node_vertex_[curve][i + 1];
        if (a == b) continue;
        std::vector<Index> between;
        bool forward = a < b;
        if (const Index edge = common_edge(mesh_, drawn.nodes[i], drawn.nodes[i + 1]); edge != no_index) {
            const auto along = [&](const SurfaceNode& node) {
                return node.kind == SurfaceNode::Kind::edge                                  ? node.parameter
                       : Vertex(node.element) == mesh_.source(mesh_.halfedge(Edge(edge), 0)) ? 0.0
                                                                                             : 1.0;
            };
            const double from = along(drawn.nodes[i]), to = along(drawn.nodes[i + 1]);
            forward = from < to;
            if (const auto found = on_edge_.find(edge); found != on_edge_.end())
                for (const auto& [parameter, v] : found->second)
                    if (parameter > std::min(from, to) && parameter < std::max(from, to) && v != a && v != b)
                        between.push_back(v);
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

Index FaceCutter::add_node(const SurfaceNode& node) {
    nodes_.push_back(node);
    return static_cast<Index>(mesh_.number_of_vertices() + nodes_.size() - 1);
}

void FaceCutter::place_nodes(const std::vector<SurfaceCurve>& curves) {
    std::map<std::tuple<Index, double>, Index> edge_vertex;
    std::map<std::tuple<Index, double, double>, Index> face_vertex;
    constexpr double same = 1e-7;  // nodes closer than this fraction of the edge are merged
    const auto missing = [](const char* what, Index i) {
        fail_input("curve", std::string("names ") + what + " " + std::to_string(i) + ", which does not exist");
    };
    for (const SurfaceCurve& curve : curves) {
        auto& vertices = node_vertex_.emplace_back();
        for (const SurfaceNode& node : curve.nodes) {
            Index v = node.element;
            if (node.kind == SurfaceNode::Kind::vertex) {
                if (v >= mesh_.number_of_vertices()) missing("vertex", v);
            } else if (node.kind == SurfaceNode::Kind::edge) {
                if (node.element >= mesh_.number_of_edges()) missing("edge", node.element);
                const auto near = edge_vertex.lower_bound({node.element, node.parameter - same});
                if (near != edge_vertex.end() && std::get<0>(near->first) == node.element &&
                    std::get<1>(near->first) <= node.parameter + same) {
                    v = near->second;
                } else {
                    v = add_node(node);
                    edge_vertex.emplace(std::make_tuple(node.element, node.parameter), v);
                    on_edge_[node.element].emplace_back(node.parameter, v);
                }
            } else {
                if (node.element >= mesh_.number_of_faces()) missing("face", node.element);
                const auto [entry, fresh] =
                    face_vertex.emplace(std::make_tuple(node.element, node.barycentric[1], node.barycentric[2]), 0);
                if (fresh) {
                    entry->second = add_node(node);
                    cuts_[node.element].inner.push_back(entry->second);
                }
                v = entry->second;
            }
            vertices.push_back(v);
        }
    }
    for (auto& [edge, list] : on_edge_) std::sort(list.begin(), list.end());
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
            for (auto i = list.begin(); i != list.end(); ++i) vertex_path.push_back(i->second);
        else
            for (auto i = list.rbegin(); i != list.rend(); ++i) vertex_path.push_back(i->second);
    }
    return vertex_path;
}

std::vector<std::array<Index, 3>> FaceCutter::cut(Index face) {
    const std::vector<Index> vertex_path = border(face);
    const auto found = cuts_.find(face);
    const Cut cut = found == cuts_.end() ? Cut{} : found->second;
    std::vector<std::array<Index, 3>> triangles;
    if (area_vector(mesh_, Face(face)).squared_length() > 0) {
        const std::size_t nodes_before = nodes_.size();
        // First with the curves; if rounding makes the boundary invalid, with the boundary only: the curves then follow edges
        // nearby.
        for (const bool with_curves : {true, false}) {
            if (triangulate(face, cut, vertex_path, with_curves, triangles)) return triangles;
            nodes_.resize(nodes_before);
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

bool FaceCutter::triangulate(Index face, const Cut& cut, const std::vector<Index>& vertex_path, bool with_curves,
                             std::vector<std::array<Index, 3>>& triangles) {
    const auto [a, b, c] = corners(mesh_, Face(face));
    const Point& origin = mesh_.point(a);
    const double scale = std::sqrt(CGAL::squared_distance(origin, mesh_.point(b)));
    const Vector x = (mesh_.point(b) - origin) / scale;
    Vector y = CGAL::cross_product(area_vector(mesh_, Face(face)), x);
    y = y / std::sqrt(y.squared_length());
    Triangulation triangulation;
    std::map<Index, Triangulation::Vertex_handle> handle;
    const auto insert = [&](Index v) {
        const Vector d = point(v) - origin;
        const auto inserted = triangulation.insert(Kernel::Point_2((d * x) / scale, (d * y) / scale));
        for (const auto& [other, other_handle] : handle)
            if (other_handle == inserted) return false;  // two vertices at the same position in the plane
        inserted->info() = v;
        handle[v] = inserted;
        return true;
    };
    for (const Index v : vertex_path)
        if (!insert(v)) return false;
    for (const Index v : cut.inner)
        if (!insert(v)) return false;
    const std::size_t known = handle.size();
    std::set<std::pair<Index, Index>> rim;
    // The vertices along a piece from v to w that is not an edge of the triangulation.
    const auto note_crossings = [&](Index v, Index w) {
        const auto from = handle.find(v), to = handle.find(w);
        if (from == handle.end() || to == handle.end() || rim.count({v, w}) > 0 ||
            triangulation.is_edge(from->second, to->second))
            return;
        const Kernel::Point_2 p = from->second->point(), q = to->second->point();
        const Kernel::Vector_2 along = q - p;
        std::vector<std::pair<double, Index>> between;
        for (const auto& [other, other_handle] : handle) {
            const Kernel::Vector_2 d = other_handle->point() - p;
            const double share = (d * along) / along.squared_length();
            if (other != v && other != w && share > 0 && share < 1 && (d - share * along).squared_length() < 1e-18)
                between.emplace_back(share, other);
        }
        std::sort(between.begin(), between.end());
        std::vector<Index>& list = crossed_[{v, w}];
        list.clear();
        for (const auto& [share, other] : between) list.push_back(other);
    };
    for (std::size_t i = 0; i < vertex_path.size(); ++i) {
        const Index v = vertex_path[i], w = vertex_path[(i + 1) % vertex_path.size()];
        rim.emplace(std::min(v, w), std::max(v, w));
        triangulation.insert_constraint(handle[v], handle[w]);
    }
    if (triangulation.number_of_vertices() != known) return false;
    if (with_curves)
        for (const auto& [v, w] : cut.segments)
            if (handle.count(v) > 0 && handle.count(w) > 0 && rim.count({v, w}) == 0)
                triangulation.insert_constraint(handle[v], handle[w]);
    if (triangulation.number_of_vertices() != known) {
        // Crossings of curves have created new vertices.
        std::set<Triangulation::Vertex_handle> old;
        for (const auto& [v, h] : handle) old.insert(h);
        std::vector<Triangulation::Vertex_handle> fresh;
        for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v)
            if (old.count(v) == 0) fresh.push_back(v);
        std::sort(fresh.begin(), fresh.end(), [](auto v, auto w) { return v->point() < w->point(); });
        for (const auto v : fresh) {
            SurfaceNode node;
            node.kind = SurfaceNode::Kind::face;
            node.element = face;
            const Point place = origin + scale * (v->point().x() * x + v->point().y() * y);
            node.barycentric = nearest_barycentric(mesh_.point(a), mesh_.point(b), mesh_.point(c), place);
            node.point = point_at(mesh_, face, node.barycentric);
            v->info() = add_node(node);
            handle[v->info()] = v;
        }
    }
    if (with_curves)
        for (const auto& [v, w] : cut.segments) note_crossings(v, w);
    // Faces of the triangulation inside the boundary: those that cannot be reached from outside without crossing it.
    const auto on_rim = [&](Triangulation::Face_handle f, int i) {
        const auto v = f->vertex(Triangulation::cw(i)), w = f->vertex(Triangulation::ccw(i));
        if (triangulation.is_infinite(v) || triangulation.is_infinite(w)) return false;
        return rim.count(std::minmax(v->info(), w->info())) > 0;
    };
    std::set<Triangulation::Face_handle> outside;
    std::vector<Triangulation::Face_handle> stack{triangulation.infinite_face()};
    outside.insert(stack.front());
    while (!stack.empty()) {
        const auto f = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i)
            if (!on_rim(f, i) && outside.insert(f->neighbor(i)).second) stack.push_back(f->neighbor(i));
    }
    std::size_t rim_edges = 0;
    for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end(); ++f) {
        if (outside.count(f) > 0) continue;
        for (int i = 0; i < 3; ++i) rim_edges += on_rim(f, i) ? 1 : 0;
        triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
    }
    if (rim_edges != rim.size() || triangles.empty()) return false;
    for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return true;
}

}  // namespace ostraka
