// Normals without the noise of a scan, with its edges.
#pragma once

#include "ostraka/core/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

/// Unit normals averaged with neighbours that look alike, in `steps` of one ring, so that sharp edges stay (bilateral normal
/// filtering, Zheng et al. 2011). `areas`: area vectors. Null vectors for what has no area.
std::vector<Vector> filtered_normals(const std::vector<Vector>& areas, const std::vector<std::pair<Index, Index>>& neighbours,
                                     int steps);
/// Steps that reach about `length` where neighbours are `spacing` apart.
int filter_steps(double length, double spacing);

/// Of the faces, over about `length`.
std::vector<Vector> filtered_normals(const Mesh& mesh, double length);

}  // namespace ostraka
