#include "ostraka/geom/geodesic.h"

#include "exact_search.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/run_apart.h"
#include "ostraka/geom/shortest_path.h"
#include "surface_patch.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace ostraka {

namespace {

using detail::ExactSearch;
using PathTraits = detail::WatchedTraits;
constexpr double infinite = std::numeric_limits<double>::infinity();

double distance(const Point& a, const Point& b) { return std::sqrt(CGAL::squared_distance(a, b)); }

/// The faces that contain a node; checks that the node belongs to the mesh.
std::vector<Face> faces_at(const Mesh& mesh, const SurfaceNode& node) {
    const auto [what, count] = node.kind == SurfaceNode::Kind::face   ? std::pair("face", mesh.number_of_faces())
                               : node.kind == SurfaceNode::Kind::edge ? std::pair("edge", mesh.number_of_edges())
                                                                      : std::pair("vertex", mesh.number_of_vertices());
    if (node.element >= count)
        fail_usage(std::string("a place on ") + what + ' ' + std::to_string(node.element) + " of " + std::to_string(count),
                   "was it taken on another mesh?");
    return faces_of(mesh, node);
}

/// The start vertices of edge paths, with the straight distance to each.
std::vector<std::pair<Vertex, double>> gates(const Mesh& mesh, const SurfaceNode& node, const std::vector<Face>& faces) {
    if (node.kind == SurfaceNode::Kind::vertex) return {{Vertex(node.element), 0.0}};
    std::vector<std::pair<Vertex, double>> list;
    for (const Face face : faces)
        for (const Vertex v : corners(mesh, face)) list.emplace_back(v, distance(node.point, mesh.point(v)));
    return list;
}

/// The face of the patch and the node's barycentric coordinates in it, in CGAL's order, which begins with the last corner.
std::pair<Face, PathTraits::Barycentric_coordinates> place_in(const Mesh& mesh, const SurfacePatch& patch,
                                                              const SurfaceNode& node, Face face) {
    const auto place = std::lower_bound(patch.faces.begin(), patch.faces.end(), static_cast<Index>(face)) - patch.faces.begin();
    std::array<double, 3> weights{0, 0, 0};
    const auto corner = corners(mesh, face);
    for (std::size_t k = 0; k < 3; ++k) {
        if (node.kind == SurfaceNode::Kind::face) weights[k] = node.barycentric[k];
        if (node.kind == SurfaceNode::Kind::vertex) weights[k] = corner[k] == Vertex(node.element) ? 1 : 0;
        if (node.kind == SurfaceNode::Kind::edge) {
            const Halfedge h = mesh.halfedge(Edge(node.element), 0);
            weights[k] = corner[k] == mesh.source(h) ? 1 - node.parameter : corner[k] == mesh.target(h) ? node.parameter : 0;
        }
    }
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
    if (job.first.faces.size() >= large) return run_apart_on(std::move(job), work);
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
        const std::vector<Face> around = faces_at(mesh, surface_node(mesh, Vertex(source)));
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

double geodesic_distance(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to) {
    const std::vector<Face> start = faces_at(mesh, from), end = faces_at(mesh, to);
    for (const Face a : start)
        if (std::find(end.begin(), end.end(), a) != end.end()) return distance(from.point, to.point);
    if (from.kind == to.kind && from.element == to.element && from.kind == SurfaceNode::Kind::vertex) return 0;
    if (start.empty() || end.empty()) return infinite;
    const std::vector<double> lengths = edge_distances(mesh, gates(mesh, from, start), infinite);
    double shortest = infinite;
    for (const auto& [v, way] : gates(mesh, to, end)) shortest = std::min(shortest, lengths[v] + way);
    if (!std::isfinite(shortest)) return infinite;
    // A curve of that length lies in the ellipsoid with both places as foci.
    const double sum = shortest * (1 + 1e-9);
    const auto met = [&](Face face) {  // also keeps a face whose distances are NaN
        return !(distance_to_face(mesh, face, from.point) + distance_to_face(mesh, face, to.point) > sum);
    };
    SurfacePatch whole = cut_out(mesh, grow_faces(mesh, start, met), from.point);
    const auto source = place_in(mesh, whole, from, start.front()), target = place_in(mesh, whole, to, end.front());
    const auto [patch, length] = searched(std::move(whole), [source, target](const SurfacePatch& own) {
        ExactSearch search(own.mesh);
        search.add_source_point(source.first, source.second);
        return static_cast<double>(search.shortest_distance_to_source_points(target.first, target.second).first);
    });
    const double exact = patch.scale * length;
    return exact >= 0 ? std::min(exact, shortest) : shortest;
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
    std::vector<SurfaceNode> nodes;

    void add(SurfaceNode node) { nodes.push_back(std::move(node)); }
    void operator()(Mesh::Vertex_index v) { add(surface_node(mesh, Vertex(patch.vertices[v]))); }
    void operator()(Mesh::Halfedge_index h, Kernel::FT along) {
        const Index a = patch.vertices[patch.mesh.source(h)], b = patch.vertices[patch.mesh.target(h)];
        SurfacePlace place;
        constexpr double snap = 1e-9;
        if (along < snap || along > 1 - snap) {
            place.element[0] = along < 0.5 ? a : b;
        } else {
            place.kind = SurfaceNode::Kind::edge;
            place.element = {std::min(a, b), std::max(a, b)};
            place.weights[0] = a < b ? along : 1 - along;
        }
        add(node_at(mesh, place));
    }
};

}  // namespace

std::optional<SurfaceCurve> geodesic_curve(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to) {
    const std::vector<Face> start = faces_at(mesh, from), end = faces_at(mesh, to);
    SurfaceCurve curve;
    curve.nodes = {from, to};
    if (const Index face = common_face(mesh, from, to); face != no_index) {
        curve.faces = {face};
        return curve;
    }
    if (start.empty() || end.empty()) return std::nullopt;
    const std::vector<double> lengths = edge_distances(mesh, gates(mesh, from, start), infinite);
    double shortest = infinite;
    for (const auto& [v, way] : gates(mesh, to, end)) shortest = std::min(shortest, lengths[v] + way);
    if (!std::isfinite(shortest)) return std::nullopt;
    const double sum = shortest * (1 + 1e-9);
    const auto met = [&](Face face) {
        return !(distance_to_face(mesh, face, from.point) + distance_to_face(mesh, face, to.point) > sum);
    };
    SurfacePatch whole = cut_out(mesh, grow_faces(mesh, start, met), from.point);
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
    if (exact >= 0 && exact <= sum) {
        std::vector<SurfaceNode> nodes{from};
        const auto add = [&](const SurfaceNode& node) {
            const SurfaceNode& last = nodes.back();
            if (node.kind == last.kind && node.element == last.element &&
                (node.kind == SurfaceNode::Kind::vertex || node.point == last.point))
                return true;
            if (common_face(mesh, last, node) == no_index) return false;
            nodes.push_back(node);
            return true;
        };
        bool joined = true;
        for (const SurfaceNode& node : places.nodes) joined = joined && add(node);
        joined = joined && add(to);
        if (joined) {
            curve.nodes = std::move(nodes);
            for (std::size_t i = 1; i < curve.nodes.size(); ++i)
                curve.faces.push_back(common_face(mesh, curve.nodes[i - 1], curve.nodes[i]));
            return curve;
        }
    }
    // Edge path from a corner of the first place's face to a corner of the last place's face.
    const auto nearest = [&](const SurfaceNode& node, const std::vector<Face>& faces) {
        if (node.kind == SurfaceNode::Kind::vertex) return Vertex(node.element);
        const auto corner = corners(mesh, faces.front());
        return *std::min_element(corner.begin(), corner.end(), [&](Vertex a, Vertex b) {
            return CGAL::squared_distance(mesh.point(a), node.point) < CGAL::squared_distance(mesh.point(b), node.point);
        });
    };
    PathSearch paths(mesh);
    curve.nodes = {from};
    for (const Index v : paths.find(nearest(from, start), nearest(to, end), {}))
        if (!(from.kind == SurfaceNode::Kind::vertex && v == from.element) &&
            !(to.kind == SurfaceNode::Kind::vertex && v == to.element))
            curve.nodes.push_back(surface_node(mesh, Vertex(v)));
    curve.nodes.push_back(to);
    for (std::size_t i = 1; i < curve.nodes.size(); ++i) {
        curve.faces.push_back(common_face(mesh, curve.nodes[i - 1], curve.nodes[i]));
        if (curve.faces.back() == no_index) return std::nullopt;
    }
    return curve;
}

}  // namespace ostraka
