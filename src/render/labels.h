// Labels beside an object, with lines to the labelled parts.
#pragma once

#include "ostraka/render/render.h"
#include "render/canvas.h"
#include "render/overlay.h"

namespace ostraka::detail {

/// Width of each of the two label columns beside a pane of this width.
double label_column(Canvas& canvas, const Scene& scene, double pane_width, const Style& style);

/// Places the labels of visible parts in two columns of width `column` beside the pane. Each label goes to the side nearer to its
/// part while there is room, in the vertical order of the parts; labels are moved apart if they overlap and exchanged if their
/// leader lines cross. The leader line of a region ends at the region's point farthest from its visible border. Time: O(pixels /
/// 16 + labels^2).
std::vector<PaneLabel> place_labels(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera,
                                    const PixelBox& pane, double column, const Style& style);

/// Draws labels with their leader lines.
void draw_labels(Canvas& canvas, const std::vector<PaneLabel>& labels, const Style& style);

}  // namespace ostraka::detail
