// Layout of a relationship graph as a drawing: the containment tree with one annotation per row, and beside the tree a bracket
// for each other relationship.
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
/// different lanes, short brackets near the tree: sorted by length, each bracket takes the first free lane. Time: O(r^2) in the
/// number of relationships.
GraphLayout layout_of(const RelationGraph& graph, const AnnotationSet& set, const ContainmentOrder& order);

}  // namespace ostraka
