// How far two meshes that should stand in one place lie apart.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>

namespace ostraka {

/// Lengths are in the unit of the coordinates. Distances are those from a sample of the source's vertices to the target's
/// surface, the mean of the nearest nine in ten: what one of the meshes lacks does not count.
struct Misalignment {
    double distance = 0;       ///< as the meshes stand
    bool stands_out = false;   ///< far more than two resolutions of one surface lie apart, and a motion would mend most of it
    double distance_left = 0;  ///< after that motion; this and what follows where it stands out
    double rotation = 0;       ///< of the target against the source, degrees
    double shift = 0;          ///< of the middle of the sample
    double scale = 1;          ///< size of the target / size of the source
};

/// Looks at 400 vertices, spread evenly over the indices; the same for any number of threads. O(log n) beyond the length of the
/// edges. For meshes that compare_alignment lets pass: a motion is looked for from near by only.
Misalignment find_misalignment(const Mesh& source, const SurfaceSearch& target);

/// What to tell of one that stands out; `unit`: of the coordinates, may be empty.
std::string in_words(const Misalignment& found, double diagonal, const std::string& unit);

}  // namespace ostraka
