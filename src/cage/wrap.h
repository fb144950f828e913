// The watertight wrap that a cage starts from.
#pragma once

#include "ostraka/core/mesh.h"

namespace ostraka::cage {

/// Closed, without self-intersections, strictly around the triangles, farther than `offset` from none of them but where an
/// opening is narrower than `alpha` (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022).
Mesh wrap(const TriangleSoup& soup, double alpha, double offset);

}  // namespace ostraka::cage
