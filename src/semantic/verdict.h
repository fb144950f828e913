// What became of an edit and of the surface, measured on the result.
#pragma once

#include "ostraka/semantic/deform.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// A flag a vertex of the mesh: whether the edit asks it to move, see EditFollowed. `displacements` are those of the edit alone.
std::vector<bool> asked_vertices(const HandleSpace& space, const EditState& last, const Points& displacements);

EditFollowed followed_edit(const HandleSpace& space, const EditState& last, const std::vector<bool>& asked, const Points& rest,
                           const Points& edited, const Points& now);

/// Of shapes of one mesh.
SurfaceChange surface_change(const Mesh& rest, const Mesh& edited, const Mesh& now);

}  // namespace ostraka::semantic
