#include "ostraka/geom/chains.h"

#include <unordered_map>

namespace ostraka {

std::vector<std::vector<std::size_t>> chains_of(const std::vector<std::array<std::size_t, 2>>& segments) {
    std::unordered_map<std::size_t, std::vector<std::size_t>> at;
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (const std::size_t end : segments[i]) at[end].push_back(i);
    std::vector<bool> used(segments.size(), false);
    std::vector<std::vector<std::size_t>> list;
    const auto follow = [&](std::size_t segment, std::size_t from) {
        std::vector<std::size_t>& chain = list.emplace_back(1, from);
        for (;;) {
            used[segment] = true;
            const std::size_t next = segments[segment][0] == chain.back() ? segments[segment][1] : segments[segment][0];
            chain.push_back(next);
            const auto& around = at[next];
            if (around.size() != 2) return;
            const std::size_t other = around[0] == segment ? around[1] : around[0];
            if (used[other]) return;
            segment = other;
        }
    };
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (const std::size_t end : segments[i])
            if (!used[i] && at[end].size() != 2) follow(i, end);
    for (std::size_t i = 0; i < segments.size(); ++i)
        if (!used[i]) follow(i, segments[i][0]);
    return list;
}

}  // namespace ostraka
