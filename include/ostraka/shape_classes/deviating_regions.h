// Measures how closely one surface lies on another: mean distance, share of the area that deviates, and the deviating regions.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>
#include <vector>

namespace ostraka {

/// A connected region of a surface that does not lie on the other surface.
struct DeviatingRegion {
    double share = 0;               ///< share of the surface's area, 0 to 1
    Point middle{0, 0, 0};          ///< centroid of the region's points
    double farthest = 0;            ///< largest distance of the region's points from the other surface, in the mesh's unit
    Point at{0, 0, 0};              ///< the point of the region at this largest distance
    Index face = no_index;          ///< face of the surface that contains the point `at`
    Index nearest_face = no_index;  ///< face of the other surface nearest to the point `at`
    std::string part;               ///< tags of the template's annotations at the point `at`, as text; empty if there are none
};

/// Deviation of one surface from another.
struct SurfaceDeviation {
    double distance = 0;                   ///< root mean square distance from the other surface, in the mesh's unit
    double share = 0;                      ///< share of the area that deviates, 0 to 1
    std::vector<DeviatingRegion> regions;  ///< deviating regions of at least one per cent of the area, largest first
};

/// Samples at most 5000 points evenly over the faces of `mesh`. A point deviates if it is farther than `max_distance` from the
/// other surface, or if no point of the other surface within that distance has a normal within 60 degrees of the point's normal.
/// A face without a sample gets the state of the face with a sample that can be reached in the fewest steps between adjacent
/// faces.
SurfaceDeviation surface_deviation(const Mesh& mesh, const SurfaceSearch& other, double max_distance);

/// Finds the inner side of the walls of a hollow object whose outer side lies on the other surface. A face belongs to the inner
/// side if it deviates (as in surface_deviation), if its normal is opposite to the normal at the nearest point of the other
/// surface, and if this point lies on the object. Returns one flag per face; connected regions of less than one per cent of the
/// area are ignored.
std::vector<bool> inner_wall_faces(const Mesh& object, const SurfaceSearch& other, double max_distance);

}  // namespace ostraka
