// The same triangles over other points.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// A copy of the mesh, property maps and all, whose vertices stand at `points`. Throws Error (usage) unless there is one for each
/// vertex.
Mesh with_points(const Mesh& mesh, const std::vector<Point>& points);

}  // namespace ostraka
