// Measures on the result how well the edit was followed and what happened to the surface.
#pragma once

#include "ostraka/semantic/deform.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Flags the mesh vertices that the edit moves, see EditFollowed. `displacements`: those of the edit alone.
std::vector<bool> asked_vertices(const HandleSpace& space, const EditState& last, const Points& displacements);

EditFollowed followed_edit(const HandleSpace& space, const EditState& last, const std::vector<bool>& asked, const Points& rest,
                           const Points& edited, const Points& now);

/// Compares three states of one mesh.
SurfaceChange surface_change(const Mesh& rest, const Mesh& edited, const Mesh& now);

}  // namespace ostraka::semantic
