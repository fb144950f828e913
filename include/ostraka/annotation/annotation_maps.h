// Annotations stored in property maps of the mesh, so that local edits preserve them.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/annotation/outline.h"

#include <map>

namespace ostraka {

/// Names of the property maps. Each map gives each element the index of a set of annotation ids in the AnnotationTable. Index 0
/// is the empty set; elements that an edit adds have index 0. The face map stores regions, the edge map poly-lines and the
/// vertex map point annotations.
inline constexpr const char* vertex_annotations = "v:annotations";
inline constexpr const char* edge_annotations = "e:annotations";  ///< map of poly-lines
inline constexpr const char* face_annotations = "f:annotations";  ///< map of regions
/// Map that gives, per face, the regions whose free outlines cut the face. A face cut by free outlines counts as inside a region
/// if most of the face's area is inside.
inline constexpr const char* face_cuts = "f:annotation-cuts";

/// The distinct sets of annotation ids, and the data that cannot be recovered from an edited mesh.
class AnnotationTable {
public:
    AnnotationTable();
    /// Returns the index of a set of annotation ids and adds the set if the table does not have it. `ids` must be ascending
    /// without repeats.
    std::uint32_t intern(const std::vector<int>& ids);
    /// The annotation ids in set number `set`.
    [[nodiscard]] const std::vector<int>& ids(std::uint32_t set) const { return sets_.at(set); }
    /// True if set number `set` contains the annotation id.
    [[nodiscard]] bool contains(std::uint32_t set, int id) const;
    [[nodiscard]] std::size_t size() const { return sets_.size(); }  ///< number of distinct sets

    /// For each id of a region: the outlines of the region before the edits.
    std::map<int, std::vector<Outline>> outlines;

private:
    std::vector<std::vector<int>> sets_;
    std::map<std::vector<int>, std::uint32_t> numbers_;
};

/// Writes the annotations into the property maps of `mesh`; existing maps are overwritten. If an edit splits a face or an edge,
/// the parts get the index of the split element. An edge between two faces with different indices lies on an outline. Time:
/// linear in the size of the mesh and the selections.
AnnotationTable attach_annotations(Mesh& mesh, const AnnotationSet& set);

/// Reads the annotations back from the property maps of an edited mesh, which must be free of garbage (collect_garbage).
/// `before`: the attached set, which provides tags, colours and attributes. `vertex_map`: for each vertex of the mesh before the
/// edits, the index of the same vertex after them (no_index: removed). Regions are read from the faces. Points and poly-lines
/// follow the vertex map and keep their order; if `vertex_map` is empty, points and poly-lines are read from the vertices and
/// edges in index order, and the pins of measures keep their vertex indices. Consecutive poly-line vertices that coincide after
/// the edits are merged; a segment that was split is followed along the edges that carry the annotation. A region without
/// remaining faces becomes a line or a point and keeps its tag; the annotation's `note` reports the change. Free annotations
/// lose their curves, which `project_curves` recomputes. Values of measures and descriptors are marked stale;
/// `refresh_measures` recomputes the values.
AnnotationSet collect_annotations(const Mesh& mesh, const AnnotationTable& table, const AnnotationSet& before,
                                  const std::vector<Index>& vertex_map = {});

/// Removes the annotation maps from the mesh.
void detach_annotations(Mesh& mesh);

/// Maps the pins of an annotation's measures by `vertex_map` (empty: unchanged) to a mesh of `vertex_count` vertices and marks
/// all values stale. A measure that loses a pin becomes a descriptor with its last value.
void move_pins(Annotation& annotation, const std::vector<Index>& vertex_map, std::size_t vertex_count);

}  // namespace ostraka
