// Measures the misalignment of two meshes that should be in the same position.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>

namespace ostraka {

/// Misalignment of a target relative to a source. Lengths are in the unit of the coordinates. Distances are means of the smallest
/// nine tenths of the distances from a sample of the source's vertices to the target's surface, so that parts missing in one of
/// the meshes are ignored.
struct Misalignment {
    double distance = 0;  ///< distance of the meshes in their given positions
    /// True: the distance is far larger than between two resolutions of one surface, and a motion of one mesh removes most of
    /// it.
    bool is_significant = false;
    /// Distance after this motion. This member and the following members are valid only if is_significant.
    double distance_left = 0;
    double rotation = 0;  ///< rotation of the target relative to the source, degrees
    double shift = 0;     ///< distance by which this motion moves the centroid of the sample
    double scale = 1;     ///< size of the target divided by size of the source
};

/// Measures the misalignment at 400 source vertices, evenly distributed over the vertex indices. The result does not depend on
/// the number of threads. Use it for meshes that compare_alignment accepts, because the motion is searched only near the given
/// position. Time: O(log n), plus the time for the mean edge lengths.
Misalignment find_misalignment(const Mesh& source, const SurfaceSearch& target);

/// Message about a significant misalignment; `diagonal`: diagonal of the meshes; `unit`: unit of the coordinates, may be empty.
std::string message_about(const Misalignment& found, double diagonal, const std::string& unit);

}  // namespace ostraka
