#include "ostraka/relation/layout.h"

#include <algorithm>
#include <unordered_map>

namespace ostraka {

GraphLayout layout_of(const RelationGraph& graph, const AnnotationSet& set, const ContainmentOrder& order) {
    GraphLayout layout;
    layout.rows = containment_tree(order);
    std::unordered_map<int, std::size_t> row_of;
    for (std::size_t r = 0; r < layout.rows.size(); ++r) row_of[set.annotations[layout.rows[r].annotation].id] = r;

    struct Bracket {
        std::size_t low, high, relationship;
    };
    std::vector<Bracket> brackets;
    layout.lanes.resize(graph.relationships.size());
    const std::string& tree = relation_type(GeometricRelation::containment).name;
    for (std::size_t i = 0; i < graph.relationships.size(); ++i) {
        const Relationship& one = graph.relationships[i];
        std::vector<std::size_t> rows;
        for (const int id : one.annotations)
            if (const auto at = row_of.find(id); at != row_of.end()) rows.push_back(at->second);
        if (one.type == tree || rows.empty()) continue;
        const auto [low, high] = std::minmax_element(rows.begin(), rows.end());
        brackets.push_back({*low, *high, i});
    }
    std::stable_sort(brackets.begin(), brackets.end(),
                     [](const Bracket& a, const Bracket& b) { return a.high - a.low < b.high - b.low; });
    std::vector<std::vector<const Bracket*>> lanes;
    for (const Bracket& bracket : brackets) {
        std::size_t lane = 0;
        const auto in_the_way = [&](const Bracket* other) { return other->low <= bracket.high && bracket.low <= other->high; };
        while (lane < lanes.size() && std::any_of(lanes[lane].begin(), lanes[lane].end(), in_the_way)) ++lane;
        if (lane == lanes.size()) lanes.emplace_back();
        lanes[lane].push_back(&bracket);
        layout.lanes[bracket.relationship] = static_cast<int>(lane);
    }
    return layout;
}

}  // namespace ostraka
