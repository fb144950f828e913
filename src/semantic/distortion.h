// Detects parts that were distorted by solving although they should have kept their shape.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::semantic {

/// Expected changes: one flag per vertex of the mesh.
struct Expected {
    std::vector<bool> change;  ///< the edit moves the vertex, or it is in a constraint that did not hold
    std::vector<bool> size;    ///< the vertex is in a constraint on size that did not hold
};

/// Finds distorted regions. A region of which most vertices were not expected to change is compared with its shape after the
/// edit: it is distorted if the root mean square deviation exceeds `options.distortion`, up to a rigid motion of the part and
/// without the vertices within `options.spread` of vertices that were expected to change, where the surface has to yield. A
/// region not expected to change in size is distorted if it has become thin. `now`: result of solving from `edited`. Sorted from
/// the most to the least distorted.
std::vector<DistortedPart> distorted_parts(AnnotatedMeshView rest, const Expected& expected, const Mesh& edited, const Mesh& now,
                                           const DeformOptions& options);

}  // namespace ostraka::semantic
