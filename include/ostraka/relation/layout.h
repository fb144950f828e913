// Layout of a drawing of a relationship graph. The drawing shows the containment tree with one annotation per row, and a
// bracket beside the tree for each other relationship.
#pragma once

#include "ostraka/relation/topology.h"

#include <optional>
#include <vector>

namespace ostraka {

/// Rows and lanes of a drawing of a relationship graph.
struct GraphLayout {
    std::vector<TreeEntry> rows;  ///< annotations from top to bottom
    /// For each relationship, the lane of its bracket, counted from the tree outwards; empty if the tree shows the relationship
    /// or it has no rows to connect.
    std::vector<std::optional<int>> lanes;
};

/// Lays out a graph. Children are placed below their container, in the order of the set. Brackets that share rows lie in
/// different lanes, with short brackets near the tree: the brackets are sorted by length, and each bracket gets the first free
/// lane. Time: O(r^2) in the number of relationships.
GraphLayout layout_of(const RelationGraph& graph, const AnnotationSet& set, const ContainmentOrder& order);

}  // namespace ostraka
