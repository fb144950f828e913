// Parts that were to stay as they are, and that solving distorts.
#pragma once

#include "ostraka/semantic/deform.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Vertices, a flag each.
struct Expected {
    std::vector<bool> change;  ///< the edit asks them to move, or a constraint that did not hold is about them
    std::vector<bool> size;    ///< such a constraint is about how large they are
};

/// Regions of which most was not expected to change, and that are another shape than the edit leaves them in: by more than
/// `options.distortion` in the root mean square, beside motions of the whole part and what is nearer to vertices that were to
/// change than `options.spread`, where the surface has to give; and regions not expected to change in size that have become thin.
/// `now` is what solving made of `edited`. The worst first.
std::vector<DistortedPart> distorted_parts(const Mesh& rest, const AnnotationSet& set, const Expected& expected,
                                           const Mesh& edited, const Mesh& now, const DeformOptions& options);

}  // namespace ostraka::semantic
