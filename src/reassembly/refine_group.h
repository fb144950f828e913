// Refines the poses of the fragments of a group together.
#pragma once

#include "ostraka/fracture/pair_registration.h"

#include <vector>

namespace ostraka {

/// Indices of two fragments that meet, and the distance within which their fractures count as touching.
struct MeetingPair {
    std::size_t first = 0, second = 0;  ///< indices in the group
    double tolerance = 0;               ///< max distance of touching fractures
};

/// Minimises the distances of all contact points from the planes at their partners over all poses except the pose of the first
/// fragment (Levenberg and Marquardt, by Ceres; a robust loss whose width is the tolerance). The contacts are updated `rounds`
/// times, with a search radius that falls from twice the tolerance to the tolerance. `poses`: for each of `fragments`, the motion
/// into one common frame.
void refine_group(const std::vector<const PreparedFracture*>& fragments, const std::vector<MeetingPair>& meetings,
                  std::vector<Motion>& poses, int rounds);

}  // namespace ostraka
