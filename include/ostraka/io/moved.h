// Applies a rigid or similarity motion to triangles of any topology.
#pragma once

#include "ostraka/geom/rigid_fit.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Moves the points of the triangles. If the motion includes a reflection, the second and third corner of each triangle (with
/// their texture coordinates) and two vertices of each tetrahedron are exchanged, so that a surface oriented outwards stays
/// oriented outwards. All other attributes keep their values. Throws Error (input) if a moved coordinate exceeds
/// `max_coordinate` or is not finite.
void move_triangles(TriangleSoup& soup, MeshExtras& extras, const Motion& motion);

}  // namespace ostraka
