// Measures on the result of a solve how closely the edit was followed, and how the surface changed.
#pragma once

#include "ostraka/semantic/deform.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// For each mesh vertex, whether the edit moves it, as EditFollowed defines. `displacements`: displacement of each vertex by the
/// edit alone.
std::vector<bool> edited_vertices(const HandleSpace& space, const EditState& last, const Points& displacements);

/// How closely the positions `now` follow the edit; `asked`: for each vertex, whether the edit moves it.
EditFollowed followed_edit(const HandleSpace& space, const EditState& last, const std::vector<bool>& asked, const Points& rest,
                           const Points& edited, const Points& now);

/// Compares three states of one mesh: at rest, after the edit, and after solving.
SurfaceChange surface_change(const Mesh& rest, const Mesh& edited, const Mesh& now);

}  // namespace ostraka::semantic
