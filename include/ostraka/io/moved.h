// Triangles of any topology, moved by a similarity.
#pragma once

#include "ostraka/geom/rigid_fit.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Moves the points of the triangles. A motion that mirrors also exchanges the second and the third corner of each triangle, with
/// the texture coordinates of these corners, and two vertices of each tetrahedron, so that a surface oriented outwards stays so.
/// All other attributes keep their values. Throws Error (input) if a moved coordinate exceeds `max_coordinate` or is not finite.
void move_triangles(TriangleSoup& soup, MeshExtras& extras, const Motion& motion);

}  // namespace ostraka
