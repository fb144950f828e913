// Misalignment of two meshes that should have the same position.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>

namespace ostraka {

/// Lengths are in the unit of the coordinates. Distances are the means of the smallest nine tenths of the distances from a
/// sample of the source's vertices to the target's surface, so that parts missing in one of the meshes are ignored.
struct Misalignment {
    double distance = 0;       ///< distance in the given positions
    bool stands_out = false;   ///< far larger than between two resolutions of one surface, and mostly removed by a motion
    double distance_left = 0;  ///< after that motion; this and the following members are valid if stands_out
    double rotation = 0;       ///< rotation of the target relative to the source, degrees
    double shift = 0;          ///< displacement of the centroid of the sample
    double scale = 1;          ///< size of the target / size of the source
};

/// Uses 400 vertices, evenly distributed over the indices; independent of the number of threads. O(log n), plus the time for
/// the mean edge lengths. For meshes accepted by compare_alignment: the motion is searched only near the given position.
Misalignment find_misalignment(const Mesh& source, const SurfaceSearch& target);

/// Message for a misalignment that stands out; `unit`: of the coordinates, may be empty.
std::string in_words(const Misalignment& found, double diagonal, const std::string& unit);

}  // namespace ostraka
