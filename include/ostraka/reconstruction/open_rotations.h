// Determines rotations about the template's axis that the pose search could not determine, by matching the fractures of the
// fragments.
#pragma once

#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/reconstruction/search_placement.h"

namespace ostraka {

/// If the template is a surface of revolution (`rotation_axis`), a pose search cannot determine the rotation of fragments about
/// its axis. This function rotates such fragments by matching fractures and writes their poses to `placed`. Fragments with a
/// known rotation are not moved, but their fractures are used. Sherd indices in the result are fragment indices; the group of a
/// fragment that is not placed is -1. Returns nothing if no rotation is undetermined, if there is only one fragment, if no
/// fragment has a fracture, or with the option "never". `scaled`: the template at the scale and in the coordinates to which the
/// poses map the fragments.
std::optional<RotationMatch> decide_open_rotations(const Mesh& scaled, const std::vector<const Fragment*>& fragments,
                                                   const std::vector<std::optional<PoseSearchResult>>& searched,
                                                   std::vector<FragmentPlacement>& placed,
                                                   const RotationMatchOptions& options = {});

}  // namespace ostraka
