// Removal of redundant places of projected curves.
#pragma once

#include "ostraka/transfer/project_curves.h"

#include <vector>

namespace ostraka {

/// Drops places inside faces that are closer than `tolerance` to the straight segment between their neighbours; the same places
/// are dropped in all curves that share them. Time: O(k log k) for k places.
void thin_out(const Mesh& mesh, double tolerance, std::vector<ProjectedAnnotation>& projected);

}  // namespace ostraka
