// Shapes as a browser gets them.
#pragma once

#include "ostraka/core/mesh.h"

#include <string>

namespace ostraka {

/// A GLB file of one mesh: positions as 16 bit steps from `origin` (KHR_mesh_quantization), compressed (EXT_meshopt_compression;
/// Kapoulkine, meshoptimizer) in the order of vertices and triangles that the mesh has. Corners of a triangle may turn.
std::string quantised_glb(const TriangleSoup& soup, const std::array<double, 3>& origin, double largest_side);

}  // namespace ostraka
