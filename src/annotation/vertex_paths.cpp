#include "vertex_paths.h"

#include <algorithm>
#include <tuple>

namespace ostraka {

std::vector<std::vector<Index>> join_into_paths(const std::vector<std::pair<Index, Index>>& edges) {
    struct Link {
        Index from, to;
        std::size_t edge;
        bool operator<(const Link& other) const { return std::tie(from, to) < std::tie(other.from, other.to); }
    };
    std::vector<Link> links;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        links.push_back({edges[e].first, edges[e].second, e});
        links.push_back({edges[e].second, edges[e].first, e});
    }
    std::sort(links.begin(), links.end());
    std::vector<bool> used(edges.size(), false);
    const auto around = [&](Index vertex) {
        return std::equal_range(links.begin(), links.end(), Link{vertex, 0, 0},
                                [](const Link& a, const Link& b) { return a.from < b.from; });
    };
    const auto unused = [&](Index vertex) {
        const auto [first, last] = around(vertex);
        return std::find_if(first, last, [&](const Link& link) { return !used[link.edge]; }) != last;
    };
    const auto degree = [&](Index vertex) {
        const auto [first, last] = around(vertex);
        return last - first;
    };
    std::vector<std::vector<Index>> vertex_paths;
    const auto walk = [&](const Link& start) {
        std::vector<Index> vertex_path{start.from, start.to};
        used[start.edge] = true;
        while (vertex_path.back() != vertex_path.front() && degree(vertex_path.back()) == 2 && unused(vertex_path.back())) {
            const auto [first, last] = around(vertex_path.back());
            const auto next = std::find_if(first, last, [&](const Link& link) { return !used[link.edge]; });
            used[next->edge] = true;
            vertex_path.push_back(next->to);
        }
        vertex_paths.push_back(std::move(vertex_path));
    };
    for (const Link& link : links)
        if (!used[link.edge] && degree(link.from) != 2) walk(link);
    for (const Link& link : links)
        if (!used[link.edge]) walk(link);
    return vertex_paths;
}

}  // namespace ostraka
