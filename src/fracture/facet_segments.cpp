// Parts of a surface between sharp convex edges.
#include "facet_evidence.h"
#include "ostraka/core/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>

namespace ostraka {

namespace {

struct Boundary {
    double length = 0, turn = 0;  ///< turn: integral along it
};

}  // namespace

std::vector<std::size_t> convex_parts(const Mesh& mesh, const std::vector<double>& areas, const std::vector<double>& turns,
                                      double sharpest) {
    const std::size_t n = areas.size();
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    std::vector<std::size_t> order(mesh.number_of_edges());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(std::abs(turns[a]), a) < std::pair(std::abs(turns[b]), b); });
    const auto sides = [&](std::size_t e) {
        const Halfedge h = mesh.halfedge(Edge(static_cast<Index>(e)));
        return std::pair(mesh.face(h), mesh.face(mesh.opposite(h)));
    };
    // Patches: small, so that a gap in an edge joins little.
    constexpr double patch = 0.002;
    DisjointSets sets(n);
    std::vector<double> size = areas;
    for (const std::size_t e : order) {
        const auto [f, g] = sides(e);
        if (f == Mesh::null_face() || g == Mesh::null_face() || std::abs(turns[e]) > sharpest) continue;
        std::size_t a = sets.find(f), b = sets.find(g);
        if (a == b || size[a] + size[b] > patch * total) continue;
        if (b < a) std::swap(a, b);
        sets.unite_into(a, b);
        size[a] += size[b];
    }
    std::vector<std::map<std::size_t, Boundary>> around(n);
    for (const Edge e : mesh.edges()) {
        const auto [f, g] = sides(e);
        if (f == Mesh::null_face() || g == Mesh::null_face()) continue;
        const std::size_t a = sets.find(f), b = sets.find(g);
        if (a == b) continue;
        const double length = std::sqrt(CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
            around[from][to].length += length;
            around[from][to].turn += length * turns[e];
        }
    }
    struct Pair {
        double turn;
        std::size_t a, b;
        unsigned when_a, when_b;
        bool operator<(const Pair& other) const { return std::tie(turn, a, b) > std::tie(other.turn, other.a, other.b); }
    };
    std::priority_queue<Pair> queue;
    std::vector<unsigned> changes(n, 0);
    const auto offer = [&](std::size_t a, std::size_t b, const Boundary& boundary) {
        if (b < a) std::swap(a, b);
        // What is tiny has no boundary of its own.
        const double weight = std::min(1.0, std::min(size[a], size[b]) / (patch / 4 * total));
        const double mean = boundary.length > 0 ? boundary.turn / boundary.length * weight : 0;
        if (mean < sharpest) queue.push({mean, a, b, changes[a], changes[b]});
    };
    for (std::size_t a = 0; a < n; ++a)
        for (const auto& [b, boundary] : around[a])
            if (a < b) offer(a, b, boundary);
    while (!queue.empty()) {
        const Pair pair = queue.top();
        queue.pop();
        if (changes[pair.a] != pair.when_a || changes[pair.b] != pair.when_b || sets.find(pair.a) != pair.a ||
            sets.find(pair.b) != pair.b)
            continue;
        std::size_t keep = pair.a, gone = pair.b;
        if (around[keep].size() < around[gone].size()) std::swap(keep, gone);
        sets.unite_into(keep, gone);
        size[keep] += size[gone];
        around[keep].erase(gone);
        around[gone].erase(keep);
        for (const auto& [other, boundary] : around[gone]) {
            around[other].erase(gone);
            Boundary& mine = around[keep][other];
            mine.length += boundary.length;
            mine.turn += boundary.turn;
            around[other][keep] = mine;
        }
        around[gone].clear();
        ++changes[keep];
        for (const auto& [other, boundary] : around[keep]) offer(keep, other, boundary);
    }
    std::vector<std::size_t> part(n), number(n, n);
    std::size_t count = 0;
    for (std::size_t f = 0; f < n; ++f) {
        const std::size_t root = sets.find(f);
        if (number[root] == n) number[root] = count++;
        part[f] = number[root];
    }
    return part;
}

}  // namespace ostraka
