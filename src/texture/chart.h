// Charts: parts of a surface projected into a plane.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka::texture {

/// A part of a surface, projected along its axis.
struct Chart {
    std::vector<Index> faces;        ///< ascending
    std::vector<Vector2d> corners;   ///< three per face; the least coordinates are 0
    double width = 0, height = 0;    ///< size of the rectangle around the corners, width >= height
    double largest_stretch = 1;      ///< largest length on the surface per length in the plane
    std::vector<bool> lies_too_steep{};  ///< for each face, whether it is too steep to be seen along the axis; empty: none is
};

/// Projects faces along the axis of a small cone around their normals, scaled to the area of the faces and turned into the
/// smallest rectangle. Faces thinner than `negligible_width` count in neither cone nor stretch.
Chart flattened(const Mesh& mesh, std::vector<Index> faces, double negligible_width);

/// Scales a chart in the plane.
void scale(Chart& chart, double factor);

/// Divides a chart, in texels, whose projection covers a texel centre twice or that has steep faces: the first of the charts
/// keeps the projection, and the others are new projections of the rest, each connected, scaled by `texels_per_length`.
std::vector<Chart> without_overlaps(const Mesh& mesh, Chart chart, double negligible_width, double texels_per_length);

}  // namespace ostraka::texture
