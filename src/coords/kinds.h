// The built-in kinds of coordinates.
#pragma once

#include "ostraka/coords/coordinates.h"

namespace ostraka::coords {

Coordinates mean_value(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions& options);
Coordinates harmonic(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions& options);
Coordinates local(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions& options);
Coordinates positive_mean_value(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions& options);
Coordinates green(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions& options);

}  // namespace ostraka::coords
