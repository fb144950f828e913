// The drawing of a vessel or sherd about its axis, and the measures that are read from it.
#pragma once

#include "catalogue/pose.h"

namespace ostraka::detail {

/// Fills the drawing, the diameter, the height and the thickness of the entry, and its statements on what is unknown.
void draw_about_axis(CatalogueEntry& entry, const Pose& pose, const CatalogueAxis& axis, double factor,
                     const CatalogueOptions& options);

}  // namespace ostraka::detail
