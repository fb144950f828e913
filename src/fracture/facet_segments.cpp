// Parts of a surface between sharp convex edges.
#include "ostraka/fracture/facet_graph.h"

#include "ostraka/core/progress.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>

namespace ostraka {

namespace {

struct Boundary {
    double length = 0, turn = 0;  ///< turn: integral along the boundary
};

}  // namespace

std::vector<std::size_t> convex_parts(const FacetGraph& graph, double sharpest) {
    const std::size_t n = graph.count();
    const auto& contacts = graph.contacts;
    std::vector<std::size_t> order(contacts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(std::abs(contacts[a].dihedral_angle), a) < std::pair(std::abs(contacts[b].dihedral_angle), b);
    });
    // Small parts first, so that a gap in an edge merges only small parts.
    constexpr double patch = 0.002;
    DisjointSets sets(n);
    std::vector<double> size = graph.areas;
    for (const std::size_t c : order) {
        if (std::abs(contacts[c].dihedral_angle) > sharpest) break;
        std::size_t a = sets.find(contacts[c].a), b = sets.find(contacts[c].b);
        if (a == b || size[a] + size[b] > patch * graph.area) continue;
        if (b < a) std::swap(a, b);
        sets.unite_into(a, b);
        size[a] += size[b];
    }
    std::vector<std::map<std::size_t, Boundary>> around(n);
    for (const auto& contact : contacts) {
        const std::size_t a = sets.find(contact.a), b = sets.find(contact.b);
        if (a == b) continue;
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
            around[from][to].length += contact.length;
            around[from][to].turn += contact.length * contact.dihedral_angle;
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
    const auto enqueue = [&](std::size_t a, std::size_t b, const Boundary& boundary) {
        if (b < a) std::swap(a, b);
        // The boundary of a tiny part is not significant.
        const double weight = std::min(1.0, std::min(size[a], size[b]) / (patch / 4 * graph.area));
        const double mean = boundary.length > 0 ? boundary.turn / boundary.length * weight : 0;
        if (mean < sharpest) queue.push({mean, a, b, changes[a], changes[b]});
    };
    for (std::size_t a = 0; a < n; ++a)
        for (const auto& [b, boundary] : around[a])
            if (a < b) enqueue(a, b, boundary);
    CancelCheck check;
    while (!queue.empty()) {
        check();
        const Pair pair = queue.top();
        queue.pop();
        if (changes[pair.a] != pair.when_a || changes[pair.b] != pair.when_b || sets.find(pair.a) != pair.a ||
            sets.find(pair.b) != pair.b)
            continue;
        std::size_t kept = pair.a, absorbed = pair.b;
        if (around[kept].size() < around[absorbed].size()) std::swap(kept, absorbed);
        sets.unite_into(kept, absorbed);
        size[kept] += size[absorbed];
        around[kept].erase(absorbed);
        around[absorbed].erase(kept);
        for (const auto& [other, boundary] : around[absorbed]) {
            around[other].erase(absorbed);
            Boundary& merged = around[kept][other];
            merged.length += boundary.length;
            merged.turn += boundary.turn;
            around[other][kept] = merged;
        }
        around[absorbed].clear();
        ++changes[kept];
        for (const auto& [other, boundary] : around[kept]) enqueue(kept, other, boundary);
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
