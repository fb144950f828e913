// Geometry in the format that browsers load.
#pragma once

#include "ostraka/io/textured_vertices.h"
#include "ostraka/mesh/mesh.h"

#include <string>

namespace ostraka {

/// A GLB file of one mesh: positions as 16-bit steps from `origin` (KHR_mesh_quantization), compressed (EXT_meshopt_compression;
/// Kapoulkine, meshoptimizer). `largest_side`: largest side of the bounding box. The order of vertices and triangles is kept; the
/// corners of a triangle may be rotated cyclically. With `textured`, the vertices of the file are these vertices: each has
/// texture coordinates (TEXCOORD_0) and the index of its vertex in the mesh (_VERTEX).
std::string quantised_glb(const TriangleSoup& soup, const std::array<double, 3>& origin, double largest_side,
                          const io::TexturedVertices* textured = nullptr);

}  // namespace ostraka
