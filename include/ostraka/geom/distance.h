// Distance between two points.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cmath>

namespace ostraka {

inline double distance(const Point& a, const Point& b) { return std::sqrt(CGAL::squared_distance(a, b)); }

}  // namespace ostraka
