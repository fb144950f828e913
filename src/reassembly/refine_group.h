// Poses of the fragments of a group refined together.
#pragma once

#include "ostraka/fracture/break_pair.h"

#include <vector>

namespace ostraka {

/// Fragments that meet, by their numbers, and the length within which their breaks are taken to touch.
struct MeetingPair {
    std::size_t first = 0, second = 0;
    double tolerance = 0;
};

/// Minimises the distances of all contact points from their planes over all poses at once but that of the first fragment
/// (Levenberg and Marquardt, by Ceres; a robust loss of the width of the tolerance); contacts are found anew `rounds` times, from
/// twice the tolerance down to it. `poses` are of each of `fragments` into one frame.
void refine_group(const std::vector<const PreparedBreak*>& fragments, const std::vector<MeetingPair>& meetings,
                  std::vector<Motion>& poses, int rounds);

}  // namespace ostraka
