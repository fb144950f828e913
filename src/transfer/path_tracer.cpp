#include "transfer/path_tracer.h"

#include "ostraka/geom/distance.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

PathTracer::PathTracer(const Mesh& source, const SurfaceSearch& target, const TransferOptions& options)
    : source_(source),
      search_(target),
      target_(target.mesh()),
      options_(options),
      metric_(options.metric),
      paths_(target.mesh()) {}

void PathTracer::match(std::vector<Index> vertices) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto found = find_correspondences(source_, vertices, search_, options_.correspondence);
    for (std::size_t i = 0; i < vertices.size(); ++i) places_[vertices[i]] = found[i];
}

double PathTracer::longest_edge(Index face) const {
    double longest = 0;
    for (const Halfedge h : CGAL::halfedges_around_face(target_.halfedge(Face(face)), target_))
        longest = std::max(longest, CGAL::squared_distance(target_.point(target_.source(h)), target_.point(target_.target(h))));
    return std::sqrt(longest);
}

double PathTracer::limit(const Correspondence& a, const Correspondence& b, double source_length) const {
    // Snapping to vertices adds up to one edge at each end, and edge paths are at most about twice as long as straight ones.
    return 3 * source_length + 3 * (longest_edge(a.place.face) + longest_edge(b.place.face));
}

const std::vector<Index>& PathTracer::path(Index a, Index b, double limit) {
    const auto key = std::minmax(a, b);
    const auto [entry, fresh] = path_cache_.try_emplace(key);
    if (fresh) {
        PathSearch::Query query;
        query.metric = metric_;
        query.limit = limit;
        entry->second = paths_.find(Vertex(key.first), Vertex(key.second), query);
    }
    return entry->second;
}

std::vector<Correspondence> PathTracer::settle(const SourcePath& vertex_path, TransferScore& score) {
    const std::size_t n = vertex_path.vertices.size();
    std::vector<Correspondence> result(n);
    for (std::size_t i = 0; i < n; ++i) result[i] = places_.at(vertex_path.vertices[i]);
    const auto source_length = [&](std::size_t i, std::size_t j) {
        return distance(source_.point(Vertex(vertex_path.vertices[i])), source_.point(Vertex(vertex_path.vertices[j])));
    };
    const auto joined = [&](const Correspondence& a, const Correspondence& b, double length) {
        return a.vertex == b.vertex || !path(a.vertex, b.vertex, limit(a, b, length)).empty();
    };
    // Runs of consecutive vertices with consistent correspondences; a vertex without a correspondence is a run of its own.
    std::vector<std::size_t> breaks;  // a break lies before vertex i
    for (std::size_t i = vertex_path.closed ? 0 : 1; i < n; ++i) {
        const std::size_t before = i == 0 ? n - 1 : i - 1;
        if (result[i].vertex == no_index || result[before].vertex == no_index ||
            !joined(result[before], result[i], source_length(before, i)))
            breaks.push_back(i);
    }
    if (breaks.empty()) return result;
    std::size_t start = 0, longest = 0;
    for (std::size_t b = 0; b <= breaks.size(); ++b) {
        std::size_t first, last;
        if (vertex_path.closed) {
            if (b == breaks.size()) break;
            first = breaks[b];
            last = breaks[(b + 1) % breaks.size()] + (b + 1 == breaks.size() ? n : 0);
        } else {
            first = b == 0 ? 0 : breaks[b - 1];
            last = b == breaks.size() ? n : breaks[b];
        }
        if (result[first % n].vertex != no_index && last - first > longest) {
            longest = last - first;
            start = first % n;
        }
    }
    if (longest == 0) return result;  // no vertex has a correspondence
    // From the trusted run outwards, each vertex must be connected to the last accepted one.
    const auto spread = [&](int sense, std::size_t steps, std::size_t from) {
        std::size_t last = from;
        double length = 0;
        std::size_t previous = from;
        for (std::size_t k = 1; k <= steps; ++k) {
            const std::size_t i = (from + (sense > 0 ? k : n - k % n)) % n;
            length += source_length(previous, i);
            previous = i;
            if (result[i].vertex == no_index) continue;
            if (!joined(result[last], result[i], length)) {
                Correspondence chosen;
                for (Correspondence& candidate :
                     candidate_correspondences(source_, vertex_path.vertices[i], search_, options_.correspondence))
                    if (joined(result[last], candidate, length)) {
                        chosen = candidate;
                        chosen.relocated = true;
                        break;
                    }
                ++score.relocated;
                result[i] = chosen;
                if (chosen.vertex == no_index) continue;
            }
            last = i;
            length = 0;
        }
    };
    if (vertex_path.closed) {
        spread(+1, n - 1, start);
    } else {
        spread(+1, n - 1 - start, start);
        spread(-1, start, start);
    }
    return result;
}

std::vector<Index> PathTracer::connect(Index a, Index b, double longest, TransferScore& score, const std::vector<bool>* used) {
    if (used != nullptr) {
        PathSearch::Query query;
        query.metric = metric_;
        query.limit = longest;
        query.blocked = [used](Vertex v) { return (*used)[v]; };
        std::vector<Index> found = paths_.find(Vertex(a), Vertex(b), query);
        if (!found.empty()) return found;
    }
    std::vector<Index> found = path(a, b, longest);
    if (found.empty()) {
        ++score.detours;
        PathSearch::Query query;
        query.metric = metric_;
        return paths_.find(Vertex(a), Vertex(b), query);
    }
    if (found.front() != a) std::reverse(found.begin(), found.end());
    return found;
}

TracedPath PathTracer::trace_edges(const SourcePath& vertex_path, TransferScore& score) {
    std::vector<Correspondence> places = settle(vertex_path, score);
    std::vector<std::size_t> at;  // path positions with a correspondence
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].vertex != no_index) at.push_back(i);
    TracedPath traced;
    traced.closed = vertex_path.closed;
    if (at.empty()) return traced;
    traced.walk.push_back(places[at.front()].vertex);
    std::vector<bool> used;
    if (options_.spikes == TransferOptions::Spikes::avoid) used.assign(target_.number_of_vertices(), false);
    const std::size_t steps = vertex_path.closed ? at.size() : at.size() - 1;
    for (std::size_t k = 0; k < steps; ++k) {
        const std::size_t i = at[k], j = at[(k + 1) % at.size()];
        if (places[i].vertex == places[j].vertex) continue;
        double length = 0;
        for (std::size_t m = i; m != j; m = (m + 1) % places.size())
            length += distance(source_.point(Vertex(vertex_path.vertices[m])),
                               source_.point(Vertex(vertex_path.vertices[(m + 1) % places.size()])));
        const std::vector<Index> found = connect(places[i].vertex, places[j].vertex, limit(places[i], places[j], length), score,
                                                 used.empty() ? nullptr : &used);
        if (found.empty()) continue;  // two components: a gap is left
        traced.walk.insert(traced.walk.end(), found.begin() + 1, found.end());
        if (!used.empty())
            for (const Index v : found) used[v] = true;
    }
    if (vertex_path.ends_on_border) {
        // The outline followed the border here; on the target, it is extended to the border again.
        const auto on_border = [&](Vertex v) { return target_.is_border(v); };
        for (const bool at_end : {true, false}) {
            const Index tip = at_end ? traced.walk.back() : traced.walk.front();
            const double search_radius = 4 * longest_edge(places[at_end ? at.back() : at.front()].place.face);
            std::vector<Index> found = paths_.find_nearest(Vertex(tip), on_border, search_radius);
            if (found.size() < 2) continue;
            if (at_end) {
                traced.walk.insert(traced.walk.end(), found.begin() + 1, found.end());
            } else {
                std::reverse(found.begin(), found.end());
                traced.walk.insert(traced.walk.begin(), found.begin(), found.end() - 1);
            }
        }
    }
    if (vertex_path.closed && traced.walk.size() > 1 && traced.walk.front() == traced.walk.back()) traced.walk.pop_back();
    traced.path = options_.spikes == TransferOptions::Spikes::keep ? traced.walk : prune_spikes(traced.walk, vertex_path.closed);
    return traced;
}

std::vector<PathTracer::Step> PathTracer::trace_curves(const SourcePath& vertex_path, TransferScore& score) {
    const std::vector<Correspondence> places = settle(vertex_path, score);
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].vertex != no_index) at.push_back(i);
    std::vector<Step> steps;
    const std::size_t count = at.empty() ? 0 : vertex_path.closed ? at.size() : at.size() - 1;
    for (std::size_t k = 0; k < count; ++k) {
        std::size_t i = at[k], j = at[(k + 1) % at.size()];
        const auto key = std::minmax(vertex_path.vertices[i], vertex_path.vertices[j]);
        const bool backwards = key.first != vertex_path.vertices[i];
        const auto known = curve_cache_.find(key);
        // A relocated correspondence is specific to this path: its curves are not shared.
        if (known != curve_cache_.end() && !places[i].relocated && !places[j].relocated) {
            steps.push_back({known->second, backwards});
            continue;
        }
        if (backwards) std::swap(i, j);
        const SurfacePoint from = surface_point(target_, places[i].place.face, places[i].place.barycentric);
        const SurfacePoint to = surface_point(target_, places[j].place.face, places[j].place.barycentric);
        const Vector up = search_.normal(places[i].place.face) + search_.normal(places[j].place.face);
        const double straight = distance(position(target_, from), position(target_, to));
        std::optional<SurfaceCurve> curve =
            trace_line(target_, from, to, up, 2 * straight + 1e-9 * longest_edge(places[i].place.face));
        if (!curve) {
            // The straight trace fails (at a fold, for example): edges are used instead, from face to corner, corner to corner,
            // corner to face.
            curve.emplace();
            curve->points.push_back(from);
            const auto lead_to = [&](const SurfacePoint& p, Index face) {
                if (same_point(target_, curve->points.back(), p)) return;
                curve->points.push_back(p);
                curve->faces.push_back(face);
            };
            std::vector<Index> corner_path =
                connect(places[i].vertex, places[j].vertex, limit(places[i], places[j], straight), score, nullptr);
            if (corner_path.empty()) continue;
            lead_to(vertex_point(corner_path.front()), places[i].place.face);
            for (std::size_t m = 1; m < corner_path.size(); ++m) {
                const Halfedge h = find_halfedge(target_, Vertex(corner_path[m - 1]), Vertex(corner_path[m]));
                lead_to(vertex_point(corner_path[m]), target_.face(target_.is_border(h) ? target_.opposite(h) : h));
            }
            lead_to(to, places[j].place.face);
        }
        if (!places[i].relocated && !places[j].relocated) curve_cache_[key] = curves_.size();
        steps.push_back({curves_.size(), backwards});
        curves_.push_back(std::move(*curve));
    }
    return steps;
}

}  // namespace ostraka
