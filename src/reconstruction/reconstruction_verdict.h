// Decides whether fragments belong to one object: evidence against it, and the verdict.
#pragma once

#include "ostraka/reconstruction/reconstruct.h"

namespace ostraka {

/// Fills in objections, strain and verdict of an otherwise complete reconstruction. `pairs`: landmarks common to each fragment
/// and the template; `placed`: the fragments in the completed object, in its order.
void judge_reconstruction(Reconstruction& result, const std::vector<std::vector<LandmarkPair>>& pairs,
                          const std::vector<int>& placed, const ReconstructOptions& options);

}  // namespace ostraka
