// Colours, labels, texture and values of a mesh that is cut along free outlines.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Computes the attributes of the cut mesh from the attributes of the uncut mesh `before`. The parts of a face inherit the
/// attributes of the face. At new vertices colours, values and texture coordinates are interpolated in the face that was cut. A
/// new vertex has the label of the corner with the largest weight. Polygons of a tetrahedral mesh are not kept. Time: linear in
/// the size of the cut mesh.
MeshExtras cut_extras(const CutMesh& cut, const Mesh& before, const MeshExtras& extras);

}  // namespace ostraka
