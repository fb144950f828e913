#include "interchange/placing.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/flood.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::interchange {

Placer::Placer(const Mesh& mesh) : mesh_(mesh), surface_(mesh) {
    std::vector<Point> points;
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v)) continue;
        vertices_.push_back(v);
        points.push_back(mesh.point(v));
    }
    if (points.empty()) fail_input("mesh", "has no faces", "give a mesh with faces");
    points_ = PointTree(points);
}

Placed Placer::place(const Point& point) const {
    Placed placed;
    placed.vertex = vertices_[points_.nearest(point).index];
    placed.to_vertex = std::sqrt(CGAL::squared_distance(point, mesh_.point(Vertex(placed.vertex))));
    placed.to_surface = std::min(surface_.closest(point).distance, placed.to_vertex);
    return placed;
}

std::vector<Index> Placer::vertex_path(const std::vector<Index>& picks, bool closed, const std::string& where) {
    std::vector<Index> stops;
    for (const Index pick : picks)
        if (stops.empty() || stops.back() != pick) stops.push_back(pick);
    while (closed && stops.size() > 1 && stops.back() == stops.front()) stops.pop_back();
    if (stops.size() < 2) return stops;
    if (closed) stops.push_back(stops.front());
    std::vector<Index> vertices{stops.front()};
    for (std::size_t i = 1; i < stops.size(); ++i) {
        const Vertex from(stops[i - 1]), to(stops[i]);
        if (find_halfedge(mesh_, from, to).is_valid()) {
            vertices.push_back(to);
            continue;
        }
        if (!paths_) paths_ = std::make_unique<PathSearch>(mesh_);
        PathSearch::Query query;
        query.metric = PathMetric::combined;
        const std::vector<Index> leg = paths_->find(from, to, query);
        if (leg.empty())
            fail_input(
                where,
                fmt::format(
                    "the vertices {} and {}, nearest to successive points, lie on parts of the mesh that are not connected",
                    from.idx(), to.idx()),
                "give the mesh that the file was made for, or one of the same connectivity");
        vertices.insert(vertices.end(), leg.begin() + 1, leg.end());
    }
    // Back-tracking along an edge is dropped.
    std::vector<Index> clean;
    for (const Index vertex : vertices) {
        if (clean.size() > 1 && clean[clean.size() - 2] == vertex) clean.pop_back();
        else clean.push_back(vertex);
    }
    return clean;
}

std::vector<bool> Placer::fill(const std::vector<std::vector<Index>>& vertex_paths, double area) const {
    std::vector<Halfedge> edges;
    for (const auto& vertex_path : vertex_paths)
        for (std::size_t i = 0; i + 1 < vertex_path.size(); ++i)
            edges.push_back(find_halfedge(mesh_, Vertex(vertex_path[i]), Vertex(vertex_path[i + 1])));
    if (edges.empty()) return {};
    if (auto filled = fill_by_winding(mesh_, edges, area)) return std::move(*filled);
    return fill_edges(mesh_, edges).selected;
}

std::vector<bool> Placer::component(Index face) const {
    std::vector<bool> selected(mesh_.number_of_faces(), false);
    flood_faces(mesh_, Face(face), selected);
    return selected;
}

PlacedAnnotations placed_annotations(Json& native, JsonValue list, const JsonValue* about, const Mesh& mesh,
                                     const std::string& where, bool same_mesh, std::vector<std::string> notes,
                                     std::vector<PlacedAnnotation> placements) {
    auto& allocator = native.GetAllocator();
    add_members(native, allocator, "mesh",
                json_object(allocator, "vertices", mesh.number_of_vertices(), "faces", mesh.number_of_faces()));
    if (about != nullptr) copy_members(native, allocator, *about, {"class", "unit", "up"});
    add_members(native, allocator, "annotations", std::move(list));
    PlacedAnnotations result;
    result.set = annotations_from_json(native, mesh, where);
    if (!same_mesh) {
        const auto refreshed = refresh_measures(mesh, result.set);
        notes.insert(notes.end(), refreshed.notes.begin(), refreshed.notes.end());
    }
    result.set.notes.insert(result.set.notes.begin(), notes.begin(), notes.end());
    result.placements = std::move(placements);
    return result;
}

}  // namespace ostraka::interchange
