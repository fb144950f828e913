#include "io/soup_edges.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <numeric>

namespace ostraka::detail {

DisjointSets joined_vertices(const TriangleSoup& soup) {
    DisjointSets sets(soup.points.size());
    for (const auto& t : soup.triangles) {
        sets.unite(t[0], t[1]);
        sets.unite(t[0], t[2]);
    }
    return sets;
}

SoupEdges group_edges(const TriangleSoup& soup) {
    check_cancelled();
    const auto count = static_cast<Index>(3 * soup.triangles.size());
    std::vector<Index> bucket_begin(soup.points.size() + 1, 0);
    const auto each_halfedge = [&](const auto& visit) {
        for (Index t = 0; 3 * t < count; ++t) {
            if (repeats_corner(soup.triangles[t])) continue;
            for (Index h = 3 * t; h < 3 * t + 3; ++h) visit(h, std::minmax({origin(soup, h), target(soup, h)}));
        }
    };
    each_halfedge([&](Index, std::pair<Index, Index> ends) { ++bucket_begin[ends.first + 1]; });
    std::partial_sum(bucket_begin.begin(), bucket_begin.end(), bucket_begin.begin());
    std::vector<std::pair<Index, Index>> bucket(bucket_begin.back());  // larger end point, halfedge
    {
        std::vector<Index> next(bucket_begin);
        each_halfedge([&](Index h, std::pair<Index, Index> ends) { bucket[next[ends.first]++] = {ends.second, h}; });
    }
    parallel_for(soup.points.size(), 4096,
                 [&](std::size_t v) { std::sort(bucket.begin() + bucket_begin[v], bucket.begin() + bucket_begin[v + 1]); });
    SoupEdges edges;
    edges.halfedges.resize(bucket.size());
    edges.begin.reserve(bucket.size() / 2 + 1);
    for (std::size_t v = 0; v + 1 < bucket_begin.size(); ++v) {
        for (Index i = bucket_begin[v]; i < bucket_begin[v + 1]; ++i) {
            if (i == bucket_begin[v] || bucket[i].first != bucket[i - 1].first) edges.begin.push_back(i);
            edges.halfedges[i] = bucket[i].second;
        }
    }
    edges.begin.push_back(static_cast<Index>(bucket.size()));
    return edges;
}

std::vector<Index> same_place(const std::vector<std::array<double, 3>>& points) {
    check_cancelled();
    const std::size_t capacity = std::bit_ceil(std::max<std::size_t>(16, 2 * points.size()));
    std::vector<Index> slots(capacity, no_index), lowest(points.size());
    for (Index v = 0; v < points.size(); ++v) {
        std::uint64_t hash = 0x9E3779B97F4A7C15ull;
        for (const double x : points[v]) {
            hash ^= std::bit_cast<std::uint64_t>(x + 0.0);
            hash *= 0xBF58476D1CE4E5B9ull;
            hash ^= hash >> 29;
        }
        std::size_t slot = hash & (capacity - 1);
        while (slots[slot] != no_index && points[slots[slot]] != points[v]) slot = (slot + 1) & (capacity - 1);
        if (slots[slot] == no_index) slots[slot] = v;
        lowest[v] = slots[slot];
    }
    return lowest;
}

void check_soup(const TriangleSoup& soup) {
    check_cancelled();
    if (soup.points.size() >= no_index / 8 || soup.triangles.size() >= no_index / 8)
        fail_work("mesh", "has more than 536 million vertices or triangles", "split it");
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (const Index v : soup.triangles[t])
            if (v >= soup.points.size())
                fail_input("triangle " + std::to_string(t), fmt::format("names vertex {} of {}", v, soup.points.size()));
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        for (const double x : soup.points[v])
            if (!(std::abs(x) <= 1e100))
                fail_input("vertex " + std::to_string(v), "has a coordinate that is not finite or is beyond 1e100",
                           "correct or remove that vertex, or scale the object");
}

DisjointSets fans_of_corners(const TriangleSoup& soup, const SoupEdges& edges) {
    check_cancelled();
    DisjointSets fans(3 * soup.triangles.size());
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index* h = edges.first(e);
        for (Index i = 1; i < edges.valence(e); ++i) {
            const bool same_direction = origin(soup, h[0]) == origin(soup, h[i]);
            fans.unite(h[0], same_direction ? h[i] : next_halfedge(h[i]));
            fans.unite(next_halfedge(h[0]), same_direction ? next_halfedge(h[i]) : h[i]);
        }
    }
    return fans;
}

}  // namespace ostraka::detail
