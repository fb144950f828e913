// Lines that stand for a surface: contours, creases, borders, edges.
#pragma once

#include "overlay.h"

namespace ostraka::detail {

/// What a draughtsman draws: where the smooth surface turns away from the viewer (on the normals interpolated between the
/// corners, Hertzmann and Zorin 2000), edges whose faces meet at more than the crease angle, and borders. Creases and borders are
/// joined to poly-lines. O(n log n).
std::vector<Line> contour_lines(const Surface& surface, const Camera& camera, double crease_cosine, const Rgb& colour,
                                double width);

/// Every edge once. O(n log n).
std::vector<Line> edge_lines(const Surface& surface, const Rgb& colour, double width);

/// A dot at each point that is in sight.
void draw_points(Canvas& canvas, const Surface& surface, const Camera& camera, const std::vector<Rgb>& colours, double radius);

}  // namespace ostraka::detail
