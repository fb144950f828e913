// Names beside an object, with lines to what they name.
#pragma once

#include "canvas.h"
#include "ostraka/render/render.h"
#include "overlay.h"

namespace ostraka::detail {

/// How wide the columns of names at both sides of a pane of this width are.
double label_column(Canvas& canvas, const Scene& scene, double pane_width, const Style& style);

/// Names of what is in sight, in two columns of this width beside the pane: each on the side that its place is nearer to as far
/// as there is room, in the order of the places from top to bottom, moved apart where they would overlap and exchanged where
/// their lines would cross. A region is named at the place in it that is farthest from its seen border. O(pixels / 16 +
/// labels^2).
std::vector<PaneLabel> place_labels(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera,
                                    const PixelBox& pane, double column, const Style& style);

void draw_labels(Canvas& canvas, const std::vector<PaneLabel>& labels, const Style& style);

}  // namespace ostraka::detail
