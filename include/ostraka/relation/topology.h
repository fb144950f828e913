// Relationships that follow from the selections alone: containment and adjacency of annotations (thesis, section 2.3).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Containment of selections (six rules) as a strict partial order. Annotations are referred to by their index in the set. If
/// two selections are equal, the container is the annotation of the whole mesh (`all`) or, if neither is, the annotation with
/// the lower id. Empty selections are ignored.
struct ContainmentOrder {
    std::vector<std::vector<std::size_t>> containers;  ///< for each annotation, all annotations that contain it, ascending
    /// For each annotation, its containers without another container in between (the transitive reduction).
    std::vector<std::vector<std::size_t>> direct;
    /// For each annotation, its direct container of smallest area, then lowest id; empty: none.
    std::vector<std::optional<std::size_t>> parent;
    std::vector<std::vector<std::size_t>> equal;  ///< groups of two or more annotations with equal selections
};

/// Two regions without common faces whose outlines share edges.
struct AdjacentPair {
    std::size_t a, b;       ///< indices in the set, a < b
    double length;          ///< total length of the shared edges, in the mesh's unit
    std::size_t edges = 0;  ///< number of shared edges
};

/// Containment and adjacency of annotations.
struct AnnotationTopology {
    ContainmentOrder order;              ///< containment of the annotations
    std::vector<AdjacentPair> adjacent;  ///< pairs in ascending order of their indices
};

/// Computes containment and adjacency of the annotations. Faces that belong to the same set of regions are processed together.
/// Time: O(size of the mesh + faces x depth) for the grouping, plus O(sets x depth x annotations / 64). Throws Error (input)
/// for more than 30000 annotations.
AnnotationTopology topology(AnnotatedMeshView object);

/// The relationships of a topology: containment (transitive reduction), equal selections, and adjacency with the shared length.
/// Ids count up from `first_id`. Returns at most `max_per_kind` relationships of containment and as many of adjacency.
std::vector<Relationship> relationships_of(const AnnotationTopology& topology, const AnnotationSet& set, int first_id,
                                           std::size_t max_per_kind = std::numeric_limits<std::size_t>::max());

/// An entry of the containment tree. The tree lists annotations below their parents, depth first, with children in the order of
/// the set. The root of the tree, which stands for the whole shape, is not listed.
struct TreeEntry {
    std::size_t annotation;  ///< index of the annotation in the set
    std::size_t depth;       ///< number of containers above the entry
};
/// Entries of the containment tree from top to bottom.
std::vector<TreeEntry> containment_tree(const ContainmentOrder& order);

}  // namespace ostraka
