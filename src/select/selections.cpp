#include "ostraka/select/selections.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/mesh/limits.h"

#include <limits>
#include <sstream>

namespace ostraka {

namespace {

constexpr double outline_tolerance = 1e-9;  ///< share of the diagonal: a seed closer to an outline than this lies on it

/// Flags the faces reached from `seed` without crossing a wall; counts them and the wall edges met.
struct Flood {
    std::vector<bool> reached;
    std::size_t count = 0, walls = 0;
};
Flood flood(const Mesh& mesh, Index seed, const std::vector<bool>& wall) {
    Flood result;
    result.reached.assign(mesh.number_of_faces(), false);
    const auto is_open = [&](Halfedge h) {
        const bool closed = !wall.empty() && wall[mesh.edge(h)];
        result.walls += closed ? 1 : 0;
        return !closed;
    };
    result.count = flood_faces(mesh, Face(seed), result.reached, is_open).size();
    return result;
}

void require_faces(const Mesh& mesh) {
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces to select from", "give another mesh");
}

std::string name_of(std::size_t pick, const std::vector<Index>& picks) {
    return "point " + std::to_string(pick) + " (vertex " + std::to_string(picks[pick]) + ")";
}

/// Drops successive equal picks, and the last of a closed path if it equals the first.
std::vector<Index> distinct(const std::vector<Index>& picks, bool closed) {
    std::vector<Index> result;
    for (const Index pick : picks)
        if (result.empty() || result.back() != pick) result.push_back(pick);
    while (closed && result.size() > 1 && result.front() == result.back()) result.pop_back();
    return result;
}

using Leg = std::vector<Index>;
using Legs = std::vector<Leg>;

/// Paths from pick to pick; with `avoid` a leg avoids the vertices of earlier legs where possible.
Legs trace(const Mesh& mesh, const std::vector<Index>& picks, bool closed, PathMetric metric, bool avoid,
           const std::string& where) {
    PathSearch search(mesh);
    std::vector<bool> used(mesh.number_of_vertices(), false);
    if (avoid)
        for (const Index pick : picks) used[pick] = true;
    Legs legs;
    const std::size_t count = closed ? picks.size() : picks.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t next = (i + 1) % picks.size();
        PathSearch::Query query;
        query.metric = metric;
        std::vector<Index> leg;
        if (avoid) {
            query.blocked = [&used](Vertex v) { return used[v]; };
            leg = search.find(Vertex(picks[i]), Vertex(picks[next]), query);
            query.blocked = nullptr;
        }
        if (leg.empty()) leg = search.find(Vertex(picks[i]), Vertex(picks[next]), query);
        if (leg.empty())
            fail_input(where, "no path along the surface joins " + name_of(i, picks) + " and " + name_of(next, picks),
                       "they lie on separate parts of the mesh: pick points on one part");
        for (const Index vertex : leg) used[vertex] = true;
        legs.push_back(std::move(leg));
    }
    return legs;
}

std::vector<Index> joined(const Legs& legs) {
    std::vector<Index> path{legs.front().front()};
    for (const auto& leg : legs) path.insert(path.end(), leg.begin() + 1, leg.end());
    return path;
}

/// True if, rotating around vertex `at` from `to` in the mesh's orientation, `x` comes before `from`.
bool on_one_side(const Mesh& mesh, Index at, Index from, Index to, Index x) {
    const Halfedge start = find_halfedge(mesh, Vertex(to), Vertex(at));
    Halfedge h = start;
    do {
        h = mesh.opposite(mesh.next(h));
        const Index around = mesh.source(h);
        if (around == from) return false;
        if (around == x) return true;
    } while (h != start);
    return false;
}

/// The first place where `b` changes to the other side of `a`, if it does so an odd number of times in total.
std::optional<Index> crossing_of(const Mesh& mesh, const Leg& a, const Leg& b) {
    std::unordered_map<Index, std::size_t> place;
    for (std::size_t i = 0; i < a.size(); ++i) place.emplace(a[i], i);
    std::size_t changes = 0;
    Index first = no_index;
    for (std::size_t k = 0; k < b.size(); ++k) {
        const auto met = place.find(b[k]);
        if (met == place.end()) continue;
        // The stretch that both legs share, as indices along a in the direction of b.
        const std::size_t begin = k, from = met->second;
        std::size_t to = from;
        int direction = 0;
        while (k + 1 < b.size()) {
            const auto next = place.find(b[k + 1]);
            if (next == place.end()) break;
            const int step = next->second == to + 1 ? 1 : next->second + 1 == to ? -1 : 0;
            if (step == 0 || (direction != 0 && step != direction)) break;
            direction = step;
            to = next->second;
            ++k;
        }
        if (direction == 0) direction = 1;
        const auto inner = [&](std::size_t i) { return i > 0 && i + 1 < a.size(); };
        if (begin == 0 || k + 1 == b.size() || !inner(from) || !inner(to)) continue;
        const auto along = [&](std::size_t i, int by) { return a[by > 0 ? i + 1 : i - 1]; };
        const bool before = on_one_side(mesh, b[begin], along(from, -direction), along(from, direction), b[begin - 1]);
        const bool after = on_one_side(mesh, b[k], along(to, -direction), along(to, direction), b[k + 1]);
        if (before == after) continue;
        if (++changes == 1) first = b[begin];
    }
    if (changes % 2 == 0) return std::nullopt;
    return first;
}

struct Crossing {
    std::size_t one = 0, other = 0;  ///< indices of the legs
    Index vertex = no_index;         ///< common vertex
};

/// The first pair of legs that cross, that is, of which one ends on the other side of the other. Legs that only touch, that run
/// together and part to the side they came from, or that meet at the end of one of them do not cross. Each leg is a path of
/// vertices that visits none twice. Linear in the total length of the legs, except for pairs that share vertices.
std::optional<Crossing> find_crossing(const Mesh& mesh, const Legs& legs) {
    std::unordered_map<Index, std::vector<std::size_t>> legs_at;
    std::set<std::pair<std::size_t, std::size_t>> meeting;
    for (std::size_t i = 0; i < legs.size(); ++i)
        for (const Index v : legs[i]) {
            auto& here = legs_at[v];
            for (const std::size_t j : here)
                if (j != i) meeting.emplace(j, i);
            here.push_back(i);
        }
    for (const auto& [one, other] : meeting)
        if (const auto vertex = crossing_of(mesh, legs[one], legs[other])) return Crossing{one, other, *vertex};
    return std::nullopt;
}

/// True if two legs share a vertex other than the end of one leg and the start of the next.
bool touch(const Legs& legs) {
    std::set<Index> seen;
    for (const Leg& leg : legs)
        for (std::size_t i = 0; i + 1 < leg.size(); ++i)
            if (!seen.insert(leg[i]).second) return true;
    return false;
}

/// The closed path of a lasso. Legs that meet are searched again with avoidance.
std::vector<Index> lasso_path(const Mesh& mesh, const std::vector<Index>& points, PathMetric metric, const std::string& where) {
    const Legs shortest = trace(mesh, points, true, metric, false, where);
    if (const auto crossing = find_crossing(mesh, shortest)) {
        std::ostringstream text;
        text << "the lasso crosses itself: the legs from " << name_of(crossing->one, points) << " and from "
             << name_of(crossing->other, points) << " cross at vertex " << crossing->vertex << " ("
             << mesh.point(Vertex(crossing->vertex)) << ")";
        fail_input(where, text.str(), "pick the points in the order in which they lie around the part");
    }
    return joined(touch(shortest) ? trace(mesh, points, true, metric, true, where) : shortest);
}

}  // namespace

Volume box_volume(const Point& min, const Point& max) {
    return [min, max](const Point& p) {
        return min.x() <= p.x() && p.x() <= max.x() && min.y() <= p.y() && p.y() <= max.y() && min.z() <= p.z() &&
               p.z() <= max.z();
    };
}

Volume sphere_volume(const Point& centre, double radius) {
    return [centre, radius](const Point& p) { return CGAL::squared_distance(p, centre) <= radius * radius; };
}

Volume halfspace_volume(const Point& point, const Vector& normal) {
    return [point, normal = scaled_vector(normal)](const Point& p) { return (p - point) * normal >= 0; };
}

std::vector<bool> faces_within(const Mesh& mesh, const Volume& volume) {
    std::vector<bool> faces(mesh.number_of_faces(), false);
    for (const Face face : mesh.faces()) faces[face] = volume(centroid(mesh, face));
    return faces;
}

std::vector<Index> vertices_within(const Mesh& mesh, const Volume& volume) {
    std::vector<Index> vertices;
    for (const Vertex vertex : mesh.vertices())
        if (!mesh.is_isolated(vertex) && volume(mesh.point(vertex))) vertices.push_back(vertex);
    return vertices;
}

Index nearest_vertex(const Mesh& mesh, const Point& point) {
    check_cancelled();
    require_faces(mesh);
    Index nearest = no_index;
    double best = std::numeric_limits<double>::infinity();
    for (const Vertex vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        const double d = CGAL::squared_distance(mesh.point(vertex), point);
        if (d < best || nearest == no_index) best = d, nearest = vertex;
    }
    return nearest;
}

Index nearest_face(const Mesh& mesh, const Point& point) {
    require_faces(mesh);
    Index nearest = no_index;
    double best = std::numeric_limits<double>::infinity();
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        const auto weights = nearest_barycentric(mesh.point(a), mesh.point(b), mesh.point(c), point);
        const double d = CGAL::squared_distance(point_at(mesh, face, weights), point);
        if (d < best || nearest == no_index) best = d, nearest = face;
    }
    return nearest;
}

std::vector<bool> component_of(const Mesh& mesh, Index seed, const std::vector<bool>& within) {
    if (seed >= mesh.number_of_faces())
        fail_input("face " + std::to_string(seed), "the mesh has " + std::to_string(mesh.number_of_faces()) + " faces");
    if (within.empty()) return flood(mesh, seed, {}).reached;
    if (!within[seed])
        fail_input("face " + std::to_string(seed), "does not belong to the selection whose part it is to show",
                   "pick a face of it");
    std::vector<bool> wall(mesh.number_of_edges(), false);
    for (const Edge e : mesh.edges())
        for (const Halfedge h : {mesh.halfedge(e, 0), mesh.halfedge(e, 1)})
            if (!mesh.is_border(h) && !within[mesh.face(h)]) wall[e] = true;
    return flood(mesh, seed, wall).reached;
}

std::vector<Index> path_through(const Mesh& mesh, const std::vector<Index>& picks, bool closed, PathMetric metric,
                                const std::string& where) {
    const std::vector<Index> points = distinct(picks, closed);
    if (points.size() < (closed ? 3U : 2U))
        fail_input(where,
                   std::string(closed ? "a closed path" : "a path") + " through " + std::to_string(points.size()) +
                       " different vertices",
                   closed ? "pick three points or more, farther apart" : "pick two points or more, farther apart");
    return joined(trace(mesh, points, closed, metric, closed, where));
}

std::vector<bool> lasso(const Mesh& mesh, const std::vector<Index>& picks, Index seed, PathMetric metric,
                        const std::string& where, const std::optional<Point>& seed_point) {
    if (seed >= mesh.number_of_faces())
        fail_input(where, "the seed is face " + std::to_string(seed) + " of " + std::to_string(mesh.number_of_faces()),
                   "pick a face of the mesh");
    const std::vector<Index> points = distinct(picks, true);
    if (points.size() < 3)
        fail_input(where, "the lasso cannot be closed: it has " + std::to_string(points.size()) + " different vertices",
                   "pick three points or more, farther apart");
    const double diagonal = box_diagonal(mesh);
    const std::vector<Index> path = lasso_path(mesh, points, metric, where);
    std::vector<bool> wall(mesh.number_of_edges(), false);
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const Vertex a(path[i]), b(path[i + 1]);
        wall[mesh.edge(find_halfedge(mesh, a, b))] = true;
        if (seed_point && distance_to_segment(*seed_point, mesh.point(a), mesh.point(b)) <= outline_tolerance * diagonal)
            fail_input(where,
                       "the seed lies on the outline, between vertices " + std::to_string(path[i]) + " and " +
                           std::to_string(path[i + 1]),
                       "put it well within the lasso");
    }
    Flood inside = flood(mesh, seed, wall);
    if (inside.walls == 0)
        fail_input(where, "the seed lies on another part of the mesh than the lasso", "put the seed within the lasso");
    if (inside.count == flood(mesh, seed, {}).count)
        fail_input(where, "the lasso does not close off any part of the surface around the seed",
                   "it may run through a handle or along a border: pick more points");
    return std::move(inside.reached);
}

}  // namespace ostraka
