// Determines the rotations about the template's axis that a pose search left undetermined, from the fractures of the fragments.
#pragma once

#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/reconstruction/search_placement.h"

namespace ostraka {

/// If the template is a surface of revolution (`rotation_axis`) and the search left the rotation of fragments about the
/// template's axis undetermined: rotates those fragments, and writes their poses to `placed`; fragments with a known rotation
/// stay fixed, and their fractures are used. Sherd indices in the result are fragment indices; the group of a fragment that is
/// not placed is -1. Returns nothing if no rotation is undetermined, if there is only one fragment, if no fragment has a
/// fracture, or with the option "never". `scaled`: the template in the target frame of the poses.
std::optional<RotationMatch> decide_open_rotations(const Mesh& scaled, const std::vector<const Fragment*>& fragments,
                                                   const std::vector<std::optional<PoseSearchResult>>& searched,
                                                   std::vector<FragmentPlacement>& placed,
                                                   const RotationMatchOptions& options = {});

}  // namespace ostraka
