// Annotations held in the mesh's own property maps, so that local edits carry them along.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/annotation/outline.h"

#include <map>

namespace ostraka {

/// Names of the maps: each holds, for every element, the number of a set of annotation ids in the table. 0 is the empty set and
/// the value of elements that an edit adds. Faces carry regions, edges carry poly-lines, vertices carry points.
inline constexpr const char* vertex_annotations = "v:annotations";
inline constexpr const char* edge_annotations = "e:annotations";
inline constexpr const char* face_annotations = "f:annotations";
/// Of each face the regions whose free outlines cut it: it is neither in nor out of them, but counted in where more of it is.
inline constexpr const char* face_cuts = "f:annotation-cuts";

/// The sets that occur, each once, and what an edited mesh can no longer tell.
class AnnotationTable {
public:
    AnnotationTable();
    /// The number of a set; `ids` ascending without repeats.
    std::uint32_t intern(const std::vector<int>& ids);
    [[nodiscard]] const std::vector<int>& ids(std::uint32_t set) const { return sets_.at(set); }
    [[nodiscard]] bool contains(std::uint32_t set, int id) const;
    [[nodiscard]] std::size_t size() const { return sets_.size(); }

    std::map<int, std::vector<Outline>> outlines;  ///< of each region when it was attached, by annotation id

private:
    std::vector<std::vector<int>> sets_;
    std::map<std::vector<int>, std::uint32_t> numbers_;
};

/// Writes the set into the maps of `mesh` (made if they are missing, overwritten if not). An edit that splits a face or an
/// edge gives the parts the number of the whole; an edge between two faces with different numbers is on an outline. Linear in the
/// mesh and the selections.
AnnotationTable attach_annotations(Mesh& mesh, const AnnotationSet& set);

/// Reads the annotations back from an edited mesh without garbage. `before` is what was attached; tags, colours and attributes
/// come from it. `vertex_map` gives for each vertex of the mesh before the edits its vertex now (no_index: gone). Regions come
/// from the faces. Points and poly-lines follow the vertex map, in their order; with an empty map they come from the vertices and
/// edges that carry them, in index order, and pins keep their indices. Poly-line vertices that became one are merged, and a link
/// that was split is followed along the edges that carry the annotation. A region that lost all its faces becomes a line or a
/// point, keeps its tag and says so in `note`. Free annotations lose their curves, which `lay_curves` gives them anew. Values of
/// measures and descriptors are marked stale: `refresh_measures` computes them anew.
AnnotationSet collect_annotations(const Mesh& mesh, const AnnotationTable& table, const AnnotationSet& before,
                                  const std::vector<Index>& vertex_map = {});

/// Removes the maps.
void detach_annotations(Mesh& mesh);

/// Moves the pins of an annotation's measures by `vertex_map` (empty: they stay) to a mesh of `vertex_count` vertices and marks
/// all values stale. A measure that loses a pin becomes a descriptor that holds its last value.
void move_pins(Annotation& annotation, const std::vector<Index>& vertex_map, std::size_t vertex_count);

}  // namespace ostraka
