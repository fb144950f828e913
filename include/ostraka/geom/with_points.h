// A mesh with new vertex positions.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// A copy of the mesh, including its property maps, with the vertex positions `points`. Throws Error (usage) unless there is
/// one point per vertex.
Mesh with_points(const Mesh& mesh, const std::vector<Point>& points);

}  // namespace ostraka
