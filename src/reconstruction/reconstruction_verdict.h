// Decides whether fragments belong to one object: collects evidence against this, and states the verdict.
#pragma once

#include "ostraka/reconstruction/reconstruct.h"

namespace ostraka {

/// Fills in objections, strain and verdict of an otherwise complete reconstruction. `pairs`: for each fragment, the landmarks
/// that it has in common with the template; `placed`: indices of the fragments in the completed object, in the order of the
/// completed object.
void judge_reconstruction(Reconstruction& result, const std::vector<std::vector<LandmarkPair>>& pairs,
                          const std::vector<int>& placed, const ReconstructOptions& options);

}  // namespace ostraka
