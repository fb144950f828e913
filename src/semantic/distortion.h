// Detects parts that should have kept their shape and were distorted by solving.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Expected changes, one flag per vertex.
struct Expected {
    std::vector<bool> change;  ///< moved by the edit, or in a constraint that did not hold
    std::vector<bool> size;    ///< in such a constraint about size
};

/// Finds distorted regions. Regions of which most vertices were not expected to change are compared with their shape after the
/// edit: they are distorted if the root mean square deviation exceeds `options.distortion`, up to a rigid motion of the part
/// and without vertices within `options.spread` of those expected to change, where the surface has to give way. Regions not
/// expected to change in size are distorted if they have become thin. `now`: result of solving from `edited`. Sorted from worst
/// to best.
std::vector<DistortedPart> distorted_parts(AnnotatedMeshView rest, const Expected& expected, const Mesh& edited, const Mesh& now,
                                           const DeformOptions& options);

}  // namespace ostraka::semantic
