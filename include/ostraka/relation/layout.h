// Layout of a relationship graph in a drawing: the containment tree with one annotation per row, and beside it a bracket for
// each other relationship.
#pragma once

#include "ostraka/relation/topology.h"

#include <optional>
#include <vector>

namespace ostraka {

struct GraphLayout {
    std::vector<TreeEntry> rows;  ///< from top to bottom
    std::vector<std::optional<int>>
        lanes;  ///< lane of each relationship, counted from the inside; none if the tree shows it or it has no rows to connect
};

/// Children are placed below their container, in the order of the set. Brackets that share rows lie in different lanes, short
/// brackets inside: sorted by length, each takes the first free lane. O(r^2) in the number of relationships.
GraphLayout layout_of(const RelationGraph& graph, const AnnotationSet& set, const ContainmentOrder& order);

}  // namespace ostraka
