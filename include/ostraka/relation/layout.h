// Where the annotations and relationships of a graph stand in a drawing: the tree of what contains what, a row an annotation, and
// beside it a bracket for each other relationship.
#pragma once

#include "ostraka/relation/topology.h"

#include <optional>
#include <vector>

namespace ostraka {

struct GraphLayout {
    std::vector<TreeEntry> rows;  ///< from above
    std::vector<std::optional<int>>
        lanes;  ///< of each relationship, from inside; none: the tree says it, or nothing is there to say
};

/// Children stand below what contains them, in the order of the set. Brackets that share rows lie in different lanes, short ones
/// inside: each in the first free lane, by length. O(r^2) in the relationships.
GraphLayout layout_of(const RelationGraph& graph, const AnnotationSet& set, const ContainmentOrder& order);

}  // namespace ostraka
