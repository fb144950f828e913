// Weights of edges of the cotangent Laplacian.
#pragma once

#include "ostraka/core/mesh.h"

namespace ostraka {

/// Half the sum of the cotangents of the angles opposite to the edge (Pinkall and Polthier 1993), each at least 0, so that
/// nothing overshoots.
double cotangent_weight(const Mesh& mesh, Edge edge);

}  // namespace ostraka
