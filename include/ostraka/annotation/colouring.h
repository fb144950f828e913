// Colours of annotations, and coloured meshes.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Colour `index` of a muted palette (render: category_colour); the first nine can be distinguished by colour-blind readers.
std::array<int, 3> distinct_colour(std::size_t index);

/// True if the region covers the whole mesh or at least 95 % of its faces.
bool covers_nearly_all(const Mesh& mesh, const Annotation& annotation);

/// A colour for the annotation `joining`, which will be added to the set: grey if the annotation covers nearly all of the mesh,
/// else the first colour of the palette not used in the set.
std::array<int, 3> unused_colour(AnnotatedMeshView object, const Annotation& joining);

/// Assigns colours to the regions of a set; no two of these regions may share a face. Regions get distinct colours until the
/// palette is used up, adjacent regions get different hues, and regions that cover nearly all of the mesh get grey. Time:
/// linear in the size of the mesh.
void colour_regions(const Mesh& mesh, AnnotationSet& set);

/// The regions of a set, by descending area; among regions of equal area, the region that is later in the set comes first.
/// Painting the regions in this order leaves the smallest (then the earliest) region on top.
std::vector<const Annotation*> regions_largest_first(AnnotatedMeshView object);

/// Colours each face and each vertex by the smallest region that covers it (grey: none), and the vertices of line and point
/// annotations by the colour of their annotation. Time: linear in the size of the mesh and the selections.
MeshExtras colour_by_annotation(AnnotatedMeshView object);

}  // namespace ostraka
