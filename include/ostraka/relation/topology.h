// Relationships that follow from the selections alone: containment and adjacency of annotations (thesis, section 2.3).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Containment (six rules) as a strict partial order. Annotations are referred to by their index in the set. Of two equal
/// selections the container is the one that is the whole mesh (`all`), otherwise the one with the lower id. Empty selections
/// are ignored.
struct ContainmentOrder {
    std::vector<std::vector<std::size_t>> containers;  ///< for each annotation all that contain it, ascending
    std::vector<std::vector<std::size_t>> direct;      ///< those with no other container in between (the transitive reduction)
    std::vector<std::optional<std::size_t>> parent;    ///< the direct container of smallest area, then lowest id
    std::vector<std::vector<std::size_t>> equal;       ///< groups of two or more equal selections
};

/// Two regions without common faces whose outlines share edges.
struct AdjacentPair {
    std::size_t a, b;  ///< indices in the set, a < b
    double length;     ///< total length of the shared edges, in the mesh's unit
    std::size_t edges = 0;
};

struct Topology {
    ContainmentOrder order;
    std::vector<AdjacentPair> adjacent;  ///< ascending
};

/// Computes containment and adjacency. Faces with the same set of regions are processed together: O(faces x depth + mesh) for
/// the grouping, then O(sets x depth x annotations / 64). Throws Error (input) for more than 30000 annotations.
Topology topology(AnnotatedMeshView object);

/// The relationships of a topology: containment (transitive reduction), equal selections, and adjacency with the shared length.
/// Ids count up from `first_id`. At most `most_of_kind` of containment and of adjacency each, the first ones.
std::vector<Relationship> relationships_of(const Topology& topology, const AnnotationSet& set, int first_id,
                                           std::size_t most_of_kind = std::numeric_limits<std::size_t>::max());

/// The containment tree: annotations below their parents, depth first, children in the order of the set. The root of the graph,
/// which stands for the whole shape, is not listed.
struct TreeEntry {
    std::size_t annotation;
    std::size_t depth;
};
std::vector<TreeEntry> containment_tree(const ContainmentOrder& order);

}  // namespace ostraka
