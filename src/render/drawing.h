// Line drawing of a surface: contours, creases, borders, edges.
#pragma once

#include "render/overlay.h"

namespace ostraka::detail {

/// Lines of a technical drawing: smooth contours, where the surface turns away from the viewer (with normals interpolated between
/// the corners, Hertzmann and Zorin 2000), creases, where the normals of adjacent faces differ by more than the crease angle
/// (`crease_cosine`: its cosine), and borders. Creases and borders are joined into poly-lines. Time: O(n log n).
std::vector<Line> contour_lines(const Surface& surface, const Camera& camera, double crease_cosine, const Rgb& colour,
                                double width);

/// All edges of the surface, each once. Time: O(n log n).
std::vector<Line> edge_lines(const Surface& surface, const Rgb& colour, double width);

/// Draws a dot at each visible point of the surface.
void draw_points(Canvas& canvas, const Surface& surface, const Camera& camera, const std::vector<Rgb>& colours, double radius);

}  // namespace ostraka::detail
