// Edges, ribs and grooves of the outside of a vessel.
#pragma once

#include "catalogue/wall_grid.h"
#include "ostraka/catalogue/entry.h"

namespace ostraka::detail {

/// Horizontal lines of the outside: edges, where the median outer profile bends by more than 25 degrees over 1/40 of the
/// height, and ribs and grooves, where its distance from the axis has a local extremum relative to the smooth profile, of more
/// than 0.3 % of the largest diameter and four times the noise of the profile. Heights ascend. `from` and `to` are not set.
std::vector<CatalogueDrawing::Line> horizontal_lines(const WallGrid& grid);

}  // namespace ostraka::detail
