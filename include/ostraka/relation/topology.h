// What the selections alone tell: which annotation is contained in which, and which are neighbours (thesis, section 2.3).
#pragma once

#include "ostraka/relation/graph.h"

namespace ostraka {

/// The six rules of containment as a strict partial order. Annotations are named by their place in the set. Of two equal
/// selections the one that is the whole mesh (`all`), then the one with the lower id, counts as the container. Empty selections
/// take no part.
struct ContainmentOrder {
    std::vector<std::vector<std::size_t>> containers;  ///< of each annotation: all that contain it, ascending
    std::vector<std::vector<std::size_t>> direct;      ///< those with no other in between (the transitive reduction)
    std::vector<std::optional<std::size_t>> parent;    ///< the direct container with the least area, then the lowest id
    std::vector<std::vector<std::size_t>> equal;       ///< groups of two or more equal selections
};

/// Two regions without a common face whose outlines share edges.
struct AdjacentPair {
    std::size_t a, b;  ///< places in the set, a < b
    double length;     ///< of the shared edges, in the mesh's unit
    std::size_t edges = 0;
};

struct Topology {
    ContainmentOrder order;
    std::vector<AdjacentPair> adjacent;  ///< ascending
};

/// Faces with the same set of regions are treated together: O(faces x depth + mesh) for the grouping, then O(sets x depth x
/// annotations / 64). Throws Error (input) for more than 30000 annotations.
Topology topology(const Mesh& mesh, const AnnotationSet& set);

/// The relationships of a topology: containment (transitive reduction), equal selections, adjacency with the shared length. Ids
/// count up from `first_id`. Of containment and of adjacency the first `most_of_kind`.
std::vector<Relationship> relationships_of(const Topology& topology, const AnnotationSet& set, int first_id,
                                           std::size_t most_of_kind = std::numeric_limits<std::size_t>::max());

/// The tree: annotations under their parents, depth first, children in the order of the set; the root of the graph, which stands
/// for the whole shape, is not listed.
struct TreeEntry {
    std::size_t annotation;
    std::size_t depth;
};
std::vector<TreeEntry> containment_tree(const ContainmentOrder& order);

}  // namespace ostraka
