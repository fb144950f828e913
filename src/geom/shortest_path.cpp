#include "ostraka/geom/shortest_path.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace ostraka {

PathMetric path_metric(const std::string& name) {
    if (name == "euclidean") return PathMetric::euclidean;
    if (name == "segment") return PathMetric::segment;
    if (name == "combined") return PathMetric::combined;
    fail_usage("path metric '" + name + "' is unknown", "use euclidean, segment or combined");
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Vector ab = b - a, ap = p - a;
    const double length2 = ab.squared_length();
    const double t = length2 > 0 ? std::clamp((ap * ab) / length2, 0.0, 1.0) : 0.0;
    return std::sqrt((ap - t * ab).squared_length());
}

double distance_to_polyline(const Point& p, const std::vector<Point>& polyline) {
    if (polyline.size() == 1) return std::sqrt(CGAL::squared_distance(p, polyline.front()));
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < polyline.size(); ++i)
        best = std::min(best, distance_to_segment(p, polyline[i], polyline[i + 1]));
    return best;
}

PathSearch::PathSearch(const Mesh& mesh) : mesh_(mesh), records_(1024) {}

PathSearch::Record& PathSearch::record(Index vertex) {
    if (2 * used_ >= records_.size()) {
        std::vector<Record> smaller(2 * records_.size());
        std::swap(records_, smaller);
        used_ = 0;
        for (const Record& old : smaller)
            if (old.search == search_) record(old.vertex) = old;
    }
    const std::size_t mask = records_.size() - 1;
    std::size_t place = (vertex * std::size_t{0x9e3779b97f4a7c15}) >> 20 & mask;  // Knuth's multiplicative hashing
    while (records_[place].search == search_ && records_[place].vertex != vertex) place = (place + 1) & mask;
    Record& found = records_[place];
    if (found.search != search_) {
        ++used_;
        found = {vertex, search_, no_index, false, std::numeric_limits<double>::infinity(), 0};
    }
    return found;
}

std::vector<Index> PathSearch::find(Vertex from, Vertex to, const Query& query) {
    if (from == to) return {static_cast<Index>(from)};
    if (mesh_.is_isolated(to)) return {};
    const std::vector<Point> guide = query.guide.empty() ? std::vector<Point>{mesh_.point(from), mesh_.point(to)} : query.guide;
    // A* if the cost includes lengths: the straight-line distance is a lower bound of the remaining Euclidean cost.
    const Point goal = mesh_.point(to);
    const bool has_length = query.metric != PathMetric::segment;
    const auto bound = [&](Vertex v) { return has_length ? std::sqrt(CGAL::squared_distance(mesh_.point(v), goal)) : 0.0; };
    return search(
        from, [&](Vertex v) { return v == to; }, bound, guide, query);
}

std::vector<Index> PathSearch::find_nearest(Vertex from, const std::function<bool(Vertex)>& goal, double limit) {
    Query query;
    query.limit = limit;
    return search(
        from, goal, [](Vertex) { return 0.0; }, {}, query);
}

std::vector<Index> PathSearch::search(Vertex from, const std::function<bool(Vertex)>& is_goal,
                                      const std::function<double(Vertex)>& bound, const std::vector<Point>& guide,
                                      const Query& query) {
    if (mesh_.is_isolated(from)) return {};
    used_ = 0;
    if (++search_ == 0) {
        std::fill(records_.begin(), records_.end(), Record{});
        search_ = 1;
    }
    const double limit = query.limit > 0 ? query.limit : std::numeric_limits<double>::infinity();
    using Entry = std::tuple<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    record(from).cost = 0;
    queue.emplace(bound(from), from);
    Vertex reached = Mesh::null_vertex();
    CancelCheck check;
    while (!queue.empty()) {
        check();
        const Vertex v(std::get<1>(queue.top()));
        queue.pop();
        Record& current = record(v);
        if (current.settled) continue;
        current.settled = true;
        const double cost_to_v = current.cost, length_to_v = current.length;
        if (is_goal(v)) {
            reached = v;
            break;
        }
        for (const Halfedge h : CGAL::halfedges_around_source(v, mesh_)) {
            const Vertex w = mesh_.target(h);
            Record& next = record(w);
            if (next.settled) continue;
            if (query.blocked && query.blocked(w) && !is_goal(w)) continue;
            const double edge = std::sqrt(CGAL::squared_distance(mesh_.point(v), mesh_.point(w)));
            const double length = length_to_v + edge;
            if (length > limit) continue;
            double step = query.metric == PathMetric::segment ? 0 : edge;
            if (query.metric != PathMetric::euclidean) step += distance_to_polyline(mesh_.point(w), guide);
            const double cost = cost_to_v + step;
            if (next.cost <= cost) continue;
            next.previous = v;
            next.cost = cost;
            next.length = length;
            queue.emplace(cost + bound(w), w);
        }
    }
    std::vector<Index> path;
    if (reached == Mesh::null_vertex()) return path;
    for (Index v = reached; v != no_index; v = record(v).previous) path.push_back(v);
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace ostraka
