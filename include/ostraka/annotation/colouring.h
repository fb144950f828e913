// Annotations as colours of a mesh.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Faces in the colour of the smallest region that covers them, grey where none does; vertices likewise, and those of poly-lines
/// and points in their colours on top. Linear in the mesh and the selections.
MeshExtras colour_by_annotation(const Mesh& mesh, const AnnotationSet& set);

}  // namespace ostraka
