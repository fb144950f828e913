// Meshes coloured by values, to visualise displacements.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/core/mesh.h"
#include "ostraka/geom/with_points.h"

#include <optional>
#include <vector>

namespace ostraka::experiments {

/// Length of each vertex's displacement between two shapes.
std::vector<double> displacements(const std::vector<Point>& from, const std::vector<Point>& to);

/// Writes a PLY whose vertices are coloured by one value each, also stored as the property "quality". The colour scale runs
/// from 0 to `maximum`, so that several meshes can share it; without `maximum`, over the given values.
void write_coloured(const Path& file, const Mesh& mesh, const std::vector<double>& values, std::optional<double> maximum = {});

}  // namespace ostraka::experiments
