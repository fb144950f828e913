// Signed volume, and meshes whose faces point inwards.
#pragma once

#include "ostraka/mesh/mesh.h"

namespace ostraka {

/// Volume that a closed mesh encloses, negative if its faces point inwards. Time: O(n).
double signed_volume(const Mesh& mesh);

/// True if the mesh is closed and encloses a negative volume: its faces point inwards. False for open meshes. Time: O(n).
bool is_inside_out(const Mesh& mesh);

/// The mesh with its faces turned over: vertices and faces keep their indices, the second and the third corner of each face are
/// exchanged. Property maps are not copied. The mesh must have no garbage.
Mesh turned_over(const Mesh& mesh);

}  // namespace ostraka
