// Denoised normals that preserve edges.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

/// Unit normals averaged with similar neighbours in `steps` one-ring iterations, so that sharp edges stay (bilateral normal
/// filtering, Zheng et al. 2011). `areas`: area vectors. The normal is a null vector where the area is 0.
std::vector<Vector> filtered_normals(const std::vector<Vector>& areas, const std::vector<std::pair<Index, Index>>& neighbours,
                                     int steps);
/// Number of filter iterations that reach about `length` if neighbours are `spacing` apart.
int filter_steps(double length, double spacing);

/// Filtered normals of the faces of a mesh, averaged over distances of about `length`.
std::vector<Vector> filtered_normals(const Mesh& mesh, double length);

}  // namespace ostraka
