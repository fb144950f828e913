// Geometry in the format that browsers load.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <string>

namespace ostraka {

/// A GLB file of one mesh: positions as 16-bit steps from `origin` (KHR_mesh_quantization), compressed (EXT_meshopt_compression;
/// Kapoulkine, meshoptimizer). `largest_side`: largest side of the bounding box. The order of vertices and triangles is kept; the
/// corners of a triangle may be rotated cyclically.
std::string quantised_glb(const TriangleSoup& soup, const std::array<double, 3>& origin, double largest_side);

}  // namespace ostraka
