// Splits vertices so that each has one pair of texture coordinates, for formats that store texture coordinates per vertex and
// not per corner.
#pragma once

#include "ostraka/image/appearance.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka::io {

/// The distinct pairs of vertex and texture coordinates of the corners of a triangle soup, ordered by vertex, then by first use.
struct TexturedVertices {
    std::vector<Index> vertex;          ///< for each pair: its vertex; vertices without faces occur once
    std::vector<TexturePoint> texture;  ///< for each pair, its texture coordinates
    std::vector<Index> pair_of_corner;  ///< for each corner of each triangle, its pair
};
/// `corner_texture` has three entries per triangle.
TexturedVertices textured_vertices(const TriangleSoup& soup, const std::vector<TexturePoint>& corner_texture);

}  // namespace ostraka::io
