#include "ostraka/geom/geodesic.h"

#include "geom/exact_search.h"
#include "geom/surface_patch.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/run_interruptibly.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace ostraka {

namespace {

using detail::ExactSearch;
using PathTraits = detail::WatchedTraits;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The faces that contain a point; checks that the point belongs to the mesh.
std::vector<Face> faces_at(const Mesh& mesh, const SurfacePoint& p) {
    if (!has_element(mesh, p))
        fail_usage(fmt::format("a place on {}, which the mesh does not have", element_name(p)), "was it taken on another mesh?");
    return faces_of(mesh, p);
}

/// The start vertices of edge paths, with the straight distance to each.
std::vector<std::pair<Vertex, double>> gates(const Mesh& mesh, const SurfacePoint& p, const std::vector<Face>& faces) {
    if (p.is_vertex()) return {{p.vertex(), 0.0}};
    const Point place = position(mesh, p);
    std::vector<std::pair<Vertex, double>> list;
    for (const Face face : faces)
        for (const Vertex v : corners(mesh, face)) list.emplace_back(v, distance(place, mesh.point(v)));
    return list;
}

/// The face of the patch and the point's weights in it, in CGAL's order, which begins with the last corner.
std::pair<Face, PathTraits::Barycentric_coordinates> place_in(const Mesh& mesh, const SurfacePatch& patch, const SurfacePoint& p,
                                                              Face face) {
    const auto place = std::lower_bound(patch.faces.begin(), patch.faces.end(), static_cast<Index>(face)) - patch.faces.begin();
    const std::array<double, 3> weights = in_face(mesh, p, face);
    return {Face(static_cast<Index>(place)), PathTraits::Barycentric_coordinates{{weights[2], weights[0], weights[1]}}};
}

double distance_to_face(const Mesh& mesh, Face face, const Point& p) {
    const auto corner = corners(mesh, face);
    const auto weights = nearest_barycentric(mesh.point(corner[0]), mesh.point(corner[1]), mesh.point(corner[2]), p);
    return distance(point_at(mesh, face, weights), p);
}

/// Calls search(patch); the result must not refer to the patch after its lifetime. A search on a large patch also takes long to
/// free its memory, so it runs apart and a cancelled caller need not wait for it. Therefore it must own all other data that it
/// uses.
template <class Search>
auto searched(SurfacePatch patch, Search search) {
    using Job = std::pair<SurfacePatch, decltype(search(patch))>;
    const auto work = [search](Job& job) { job.second = search(job.first); };
    constexpr std::size_t large = 20000;
    Job job(std::move(patch), {});
    if (job.first.faces.size() >= large) return run_interruptibly_on(std::move(job), work);
    work(job);
    return job;
}

}  // namespace

std::vector<double> edge_distances(const Mesh& mesh, const std::vector<std::pair<Vertex, double>>& start, double limit) {
    std::vector<double> lengths(mesh.number_of_vertices(), infinite);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    const auto meet = [&](Vertex v, double length) {
        if (length > limit || length >= lengths[v]) return;
        lengths[v] = length;
        front.emplace(length, v);
    };
    for (const auto& [v, length] : start) meet(v, length);
    CancelCheck check;
    while (!front.empty()) {
        check();
        const auto [length, index] = front.top();
        front.pop();
        if (length > lengths[index] || mesh.is_isolated(Vertex(index))) continue;
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(Vertex(index))))
            meet(mesh.source(h), length + distance(mesh.point(Vertex(index)), mesh.point(mesh.source(h))));
    }
    return lengths;
}

std::vector<double> geodesic_distances(const Mesh& mesh, const std::vector<Index>& sources, double limit) {
    if (sources.empty()) fail_usage("there is no vertex to measure distances from", "give one");
    if (!(limit >= 0)) fail_usage("distances up to a limit of " + std::to_string(limit), "use a limit of 0 or more");
    std::vector<Face> start;
    std::vector<Point> places;
    std::vector<std::pair<Vertex, double>> gates;
    std::vector<double> result(mesh.number_of_vertices(), infinite);
    for (const Index source : sources) {
        if (source >= mesh.number_of_vertices())
            fail_usage("vertex " + std::to_string(source) + " is not one of the " + std::to_string(mesh.number_of_vertices()),
                       "was it picked on another mesh?");
        result[source] = 0;
        const std::vector<Face> around = faces_at(mesh, vertex_point(source));
        start.insert(start.end(), around.begin(), around.end());
        places.push_back(mesh.point(Vertex(source)));
        gates.emplace_back(Vertex(source), 0.0);
    }
    if (start.empty()) return result;
    std::vector<Index> faces;
    if (std::isfinite(limit)) {
        const PointTree near(places);
        faces = grow_faces(mesh, start, [&](Face face) { return may_hold_near(mesh, face, near, limit); });
    } else {
        faces = grow_faces(mesh, start, [](Face) { return true; });
    }
    SurfacePatch whole = cut_out(mesh, std::move(faces), places.front());
    std::vector<Vertex> from;
    for (const Vertex v : whole.mesh.vertices())
        if (result[whole.vertices[v]] == 0) from.push_back(v);
    const auto [patch, lengths] = searched(std::move(whole), [from](const SurfacePatch& own) {
        ExactSearch search(own.mesh);
        for (const Vertex v : from) search.add_source_point(v);
        search.build_sequence_tree();
        std::vector<double> list;
        CancelCheck check;
        for (const Vertex v : own.mesh.vertices()) {
            check();
            list.push_back(search.shortest_distance_to_source_points(v).first);
        }
        return list;
    });
    const std::vector<double> along_edges = edge_distances(mesh, gates, limit);
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = std::min(result[v], along_edges[v]);
    for (const Vertex v : patch.mesh.vertices()) {
        const double exact = patch.scale * lengths[v];
        if (exact >= 0 && exact <= limit) result[patch.vertices[v]] = std::min(result[patch.vertices[v]], exact);
    }
    return result;
}

namespace {

/// Two places on a mesh that do not lie in a common face.
struct Route {
    const Mesh& mesh;
    const SurfacePoint &from, &to;
    std::vector<Face> start, end;   ///< the faces that contain the places
    double along_edges = infinite;  ///< length of the shortest path along edges

    /// The faces that a curve of that length can meet: it lies in the ellipsoid with both places as foci.
    [[nodiscard]] SurfacePatch patch() const {
        const Point first = position(mesh, from), last = position(mesh, to);
        const auto met = [&](Face face) {  // also keeps a face whose distances are NaN
            return !(distance_to_face(mesh, face, first) + distance_to_face(mesh, face, last) > longest());
        };
        return cut_out(mesh, grow_faces(mesh, start, met), first);
    }
    [[nodiscard]] double longest() const { return along_edges * (1 + 1e-9); }
};

/// Nothing if no path along edges joins the places.
std::optional<Route> route_between(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to) {
    Route route{mesh, from, to, faces_at(mesh, from), faces_at(mesh, to)};
    if (route.start.empty() || route.end.empty()) return std::nullopt;
    const std::vector<double> lengths = edge_distances(mesh, gates(mesh, from, route.start), infinite);
    for (const auto& [v, way] : gates(mesh, to, route.end)) route.along_edges = std::min(route.along_edges, lengths[v] + way);
    if (!std::isfinite(route.along_edges)) return std::nullopt;
    return route;
}

}  // namespace

double geodesic_distance(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to) {
    const std::vector<Face> start = faces_at(mesh, from), end = faces_at(mesh, to);
    if (std::find_first_of(start.begin(), start.end(), end.begin(), end.end()) != start.end())
        return distance(position(mesh, from), position(mesh, to));
    if (from.is_vertex() && from == to) return 0;
    const std::optional<Route> route = route_between(mesh, from, to);
    if (!route) return infinite;
    SurfacePatch whole = route->patch();
    const auto source = place_in(mesh, whole, from, start.front()), target = place_in(mesh, whole, to, end.front());
    const auto [patch, length] = searched(std::move(whole), [source, target](const SurfacePatch& own) {
        ExactSearch search(own.mesh);
        search.add_source_point(source.first, source.second);
        return static_cast<double>(search.shortest_distance_to_source_points(target.first, target.second).first);
    });
    const double exact = patch.scale * length;
    return exact >= 0 ? std::min(exact, route->along_edges) : route->along_edges;
}

namespace {

/// Vertices and halfedges (with the fraction of their length) that a path on a patch traverses.
struct PathSteps {
    struct Step {
        Vertex vertex;
        Halfedge halfedge;
        double along = 0;
    };
    std::vector<Step> steps;
    double length = -1;

    void operator()(Mesh::Vertex_index v) { steps.push_back({v, Mesh::null_halfedge(), 0}); }
    void operator()(Mesh::Halfedge_index h, Kernel::FT along) { steps.push_back({Mesh::null_vertex(), h, along}); }
    void operator()(Mesh::Face_index, PathTraits::Barycentric_coordinates) {}  // one of the ends, which are known
};

/// Converts a path on a patch to places on the whole mesh.
struct PathPlaces {
    const Mesh& mesh;
    const SurfacePatch& patch;
    std::vector<SurfacePoint> points;

    void operator()(Mesh::Vertex_index v) { points.push_back(vertex_point(patch.vertices[v])); }
    void operator()(Mesh::Halfedge_index h, Kernel::FT along) {
        const Index a = patch.vertices[patch.mesh.source(h)], b = patch.vertices[patch.mesh.target(h)];
        constexpr double snap = 1e-9;
        if (along < snap || along > 1 - snap) points.push_back(vertex_point(along < 0.5 ? a : b));
        else points.push_back(ordered_edge_point(a, b, along));
    }
};

/// The curve from `from` through the points to `to`; nothing if consecutive ones have no common face.
std::optional<SurfaceCurve> joined(const Mesh& mesh, const SurfacePoint& from, const std::vector<SurfacePoint>& between,
                                   const SurfacePoint& to) {
    SurfaceCurve curve;
    curve.points = {from};
    const auto add = [&](const SurfacePoint& p) {
        if (same_point(mesh, p, curve.points.back())) return true;
        const Index face = shared_face(mesh, curve.points.back(), p);
        if (face == no_index) return false;
        curve.points.push_back(p);
        curve.faces.push_back(face);
        return true;
    };
    if (!std::all_of(between.begin(), between.end(), add) || !add(to)) return std::nullopt;
    return curve;
}

/// The shortest edge path from a corner of the first place's face to a corner of the last place's face, with both places.
std::optional<SurfaceCurve> curve_along_edges(const Route& route) {
    const Mesh& mesh = route.mesh;
    const auto nearest = [&](const SurfacePoint& p, const std::vector<Face>& faces) {
        if (p.is_vertex()) return p.vertex();
        const Point place = position(mesh, p);
        const auto corner = corners(mesh, faces.front());
        return *std::min_element(corner.begin(), corner.end(), [&](Vertex a, Vertex b) {
            return CGAL::squared_distance(mesh.point(a), place) < CGAL::squared_distance(mesh.point(b), place);
        });
    };
    std::vector<SurfacePoint> points{route.from};
    for (const Index v : PathSearch(mesh).find(nearest(route.from, route.start), nearest(route.to, route.end), {}))
        if (const SurfacePoint p = vertex_point(v); p != route.from && p != route.to) points.push_back(p);
    points.push_back(route.to);
    SurfaceCurve curve;
    for (std::size_t i = 1; i < points.size(); ++i) {
        curve.faces.push_back(shared_face(mesh, points[i - 1], points[i]));
        if (curve.faces.back() == no_index) return std::nullopt;
    }
    curve.points = std::move(points);
    return curve;
}

}  // namespace

std::optional<SurfaceCurve> geodesic_curve(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to) {
    const std::vector<Face> start = faces_at(mesh, from), end = faces_at(mesh, to);
    if (const Index face = shared_face(mesh, from, to); face != no_index) return SurfaceCurve{{from, to}, {face}};
    const std::optional<Route> route = route_between(mesh, from, to);
    if (!route) return std::nullopt;
    SurfacePatch whole = route->patch();
    // Searched from the end, so that the sequence begins at the start.
    const auto source = place_in(mesh, whole, to, end.front()), target = place_in(mesh, whole, from, start.front());
    const auto [patch, path] = searched(std::move(whole), [source, target](const SurfacePatch& own) {
        ExactSearch search(own.mesh);
        search.add_source_point(source.first, source.second);
        PathSteps steps;
        steps.length = search.shortest_path_sequence_to_source_points(target.first, target.second, steps).first;
        return steps;
    });
    PathPlaces places{mesh, patch, {}};
    for (const auto& step : path.steps) {
        if (step.halfedge == Mesh::null_halfedge()) places(step.vertex);
        else places(step.halfedge, step.along);
    }
    const double exact = patch.scale * path.length;
    if (exact >= 0 && exact <= route->longest())
        if (auto curve = joined(mesh, from, places.points, to)) return curve;
    return curve_along_edges(*route);
}

}  // namespace ostraka
