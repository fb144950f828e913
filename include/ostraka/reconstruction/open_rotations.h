// Turns about the template's axis that a search left open, decided by the fragments' breaks.
#pragma once

#include "ostraka/fracture/rotational_matching.h"
#include "ostraka/reconstruction/search_placement.h"

namespace ostraka {

/// Where the template is a surface of revolution (`rotation_axis`) and the search left a fragment free to turn about its axis:
/// turns those fragments, and writes their poses into `placed`; fragments whose turn is known stay and count. Numbers of sherds
/// in the result are those of fragments; one that is not placed has the group -1. Nothing where no turn is open, where there is
/// but one fragment, where no fragment has a break, or with the option "never". `scaled` is the template as the poses have it.
std::optional<BreakTurns> decide_free_turns(const Mesh& scaled, const std::vector<const Fragment*>& fragments,
                                            const std::vector<std::optional<PoseSearchResult>>& searched,
                                            std::vector<FragmentPlacement>& placed, const BreakTurnOptions& options = {});

}  // namespace ostraka
