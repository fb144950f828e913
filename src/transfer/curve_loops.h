// Removal of small loops and small parts that arise when curves are projected onto another surface.
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Removes loops in which a curve meets or intersects itself if the loops enclose less than the square of `edge` and are at most
/// 20 `edge` long; `edge`: typical edge length. The ends of the curve are fixed; a closed curve, which repeats its first place,
/// may start elsewhere afterwards. Time: O(km) for k places, of which m lie on a stretch of length 20 `edge`.
std::vector<SurfacePoint> without_small_loops(const Mesh& mesh, std::vector<SurfacePoint> places, double edge, bool closed);

/// Removes parts of a region with an area below `area` and fills holes with an area below `area`, smallest first, until the
/// region has at most `outlines` outlines or no small part or hole is left. `selected`: for each face, whether it is in the
/// region. Time: O(n log n) for n faces.
void dissolve_small_parts(const Mesh& mesh, double area, std::size_t outlines, std::vector<bool>& selected);

}  // namespace ostraka
