// Rotations about the template's axis that a search left open, decided by the fragments' breaks.
#pragma once

#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/reconstruction/search_placement.h"

namespace ostraka {

/// Where the template is a surface of revolution (`rotation_axis`) and the search left a fragment free to rotate about its axis:
/// rotates those fragments, and writes their poses into `placed`; fragments whose rotation is known stay and count. Numbers of
/// sherds in the result are those of fragments; one that is not placed has the group -1. Nothing where no rotation is open, where
/// there is but one fragment, where no fragment has a break, or with the option "never". `scaled` is the template as the poses
/// have it.
std::optional<RotationMatch> decide_open_rotations(const Mesh& scaled, const std::vector<const Fragment*>& fragments,
                                                   const std::vector<std::optional<PoseSearchResult>>& searched,
                                                   std::vector<FragmentPlacement>& placed,
                                                   const RotationMatchOptions& options = {});

}  // namespace ostraka
