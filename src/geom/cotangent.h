// Edge weights of the cotangent Laplacian.
#pragma once

#include "ostraka/mesh/mesh.h"

namespace ostraka {

/// Weight of an edge: half the sum of the cotangents of the angles opposite the edge (Pinkall and Polthier 1993); each cotangent
/// is clamped to at least 0 to avoid overshoots.
double cotangent_weight(const Mesh& mesh, Edge edge);

}  // namespace ostraka
