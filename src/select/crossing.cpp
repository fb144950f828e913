#include "crossing.h"

#include <set>
#include <unordered_map>

namespace ostraka {

namespace {

using Leg = std::vector<Index>;

/// True if, going round vertex `at` from `to` in the mesh's sense of rotation, `x` comes before `from`.
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

/// Where `b` changes the side of `a` for an odd number of times in all: the first such place.
std::optional<Index> crossing_of(const Mesh& mesh, const Leg& a, const Leg& b) {
    std::unordered_map<Index, std::size_t> place;
    for (std::size_t i = 0; i < a.size(); ++i) place.emplace(a[i], i);
    std::size_t changes = 0;
    Index first = no_index;
    for (std::size_t k = 0; k < b.size(); ++k) {
        const auto met = place.find(b[k]);
        if (met == place.end()) continue;
        // The stretch that both legs share, along a in the direction of b.
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

}  // namespace

std::optional<Crossing> find_crossing(const Mesh& mesh, const std::vector<Leg>& legs) {
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

bool touch(const std::vector<Leg>& legs) {
    std::set<Index> seen;
    for (const Leg& leg : legs)
        for (std::size_t i = 0; i + 1 < leg.size(); ++i)
            if (!seen.insert(leg[i]).second) return true;
    return false;
}

}  // namespace ostraka
