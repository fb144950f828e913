// Meshes coloured by numbers, for a look at where things moved.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/core/mesh.h"
#include "ostraka/geom/with_points.h"

#include <optional>
#include <vector>

namespace ostraka::experiments {

/// Length of each vertex's way from one shape to the other.
std::vector<double> displacements(const std::vector<Point>& from, const std::vector<Point>& to);

/// Writes a PLY whose vertices are coloured by one number each, which also are the property "quality". Colours go from 0 to
/// `maximum`, so that several meshes can have one scale; without it, over the numbers there are.
void write_coloured(const Path& file, const Mesh& mesh, const std::vector<double>& values, std::optional<double> maximum = {});

}  // namespace ostraka::experiments
