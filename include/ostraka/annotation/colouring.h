// Colours of annotations, and annotations as colours of a mesh.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Colour number `index` of a calm palette (render: category_colour): the first nine can be told apart by colour-blind readers.
std::array<int, 3> distinct_colour(std::size_t index);

/// A region that is the whole mesh, or 95 % of its faces.
bool covers_nearly_all(const Mesh& mesh, const Annotation& annotation);

/// The colour of an annotation that joins the set and has none of its own: neutral where it covers nearly all, else the
/// first of the palette that no annotation of the set has.
std::array<int, 3> fresh_colour(const Mesh& mesh, const AnnotationSet& set, const Annotation& joining);

/// New colours for the regions of a set, which share no face: each its own as long as the palette lasts, neighbours of different
/// hues, neutral what covers nearly all. Linear.
void colour_regions(const Mesh& mesh, AnnotationSet& set);

/// The regions of a set, largest area first; of equal ones the later in the set first, so that painting them in this order leaves
/// the smallest, then the earliest, on top.
std::vector<const Annotation*> regions_largest_first(const Mesh& mesh, const AnnotationSet& set);

/// Faces in the colour of the smallest region that covers them, grey where none does; vertices likewise, and those of poly-lines
/// and points in their colours on top. Linear in the mesh and the selections.
MeshExtras colour_by_annotation(const Mesh& mesh, const AnnotationSet& set);

}  // namespace ostraka
