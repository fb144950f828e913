// Whether fragments are of one object: what speaks against it, and the verdict.
#pragma once

#include "ostraka/reconstruction/reconstruct.h"

namespace ostraka {

/// Fills in objections, strain and verdict of a reconstruction of which all else is known. `pairs` of each fragment with the
/// template; `placed`: which fragments the completed object is made of, in its order.
void judge_reconstruction(Reconstruction& result, const std::vector<std::vector<LandmarkPair>>& pairs,
                          const std::vector<int>& placed, const ReconstructOptions& options);

}  // namespace ostraka
