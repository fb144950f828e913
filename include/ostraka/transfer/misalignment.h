// Misalignment of two meshes that should be in the same position.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>

namespace ostraka {

/// Misalignment of a target relative to a source. Lengths are in the unit of the coordinates. Distances are means of the smallest
/// nine tenths of the distances from a sample of the source's vertices to the target's surface, so that parts missing in one of
/// the meshes are ignored.
struct Misalignment {
    double distance = 0;  ///< distance in the given positions
    /// True: the distance is far larger than between two resolutions of one surface, and a motion removes most of it.
    bool is_significant = false;
    double distance_left = 0;  ///< distance after that motion; valid, like the following members, if is_significant
    double rotation = 0;       ///< rotation of the target relative to the source, degrees
    double shift = 0;          ///< distance by which the centroid of the sample moves
    double scale = 1;          ///< size of the target divided by size of the source
};

/// Measures the misalignment at 400 vertices, evenly distributed over the indices; independent of the number of threads. Time:
/// O(log n), plus the time for the mean edge lengths. For meshes accepted by compare_alignment, since the motion is searched only
/// near the given position.
Misalignment find_misalignment(const Mesh& source, const SurfaceSearch& target);

/// Message for a misalignment that stands out; `diagonal`: diagonal of the meshes; `unit`: unit of the coordinates, may be empty.
std::string message_about(const Misalignment& found, double diagonal, const std::string& unit);

}  // namespace ostraka
