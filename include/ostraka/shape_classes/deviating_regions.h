// How well one surface lies on another: distance, share of the area that is off, and regions that are off.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>
#include <vector>

namespace ostraka {

/// A connected region of a surface that does not lie on the other surface.
struct DeviatingRegion {
    double share = 0;               ///< share of the surface's area
    Point middle{0, 0, 0};          ///< centroid of the region's points
    double farthest = 0;            ///< largest distance of its points from the other surface, in the mesh's unit
    Point at{0, 0, 0};              ///< the farthest point
    Index face = no_index;          ///< face of the surface that contains the farthest point
    Index nearest_face = no_index;  ///< face of the other surface nearest to that point
    std::string part;               ///< text: annotations of the template at that point; empty if there are none
};

struct SurfaceDeviation {
    double distance = 0;                   ///< root mean square distance to the other surface, in the mesh's unit
    double share = 0;                      ///< share of the area that is off
    std::vector<DeviatingRegion> regions;  ///< regions of at least one per cent of the area, largest first
};

/// Samples at most 5000 points evenly over the faces. A point is off if it is farther than `max_distance` from the other surface,
/// or if no point of the other surface within that distance has a normal within 60 degrees of its own. A face without a sample
/// takes the state of the nearest face with one, in steps between adjacent faces.
SurfaceDeviation surface_deviation(const Mesh& mesh, const SurfaceSearch& other, double max_distance);

/// Finds the faces of an object that form the inside of walls whose outside lies on the other surface: faces that are off (as
/// in surface_deviation), whose normal points away from that of the nearest point of the other surface, where this point in turn
/// lies on the object. Returns one flag per face; connected regions of less than one per cent of the area are ignored.
std::vector<bool> inner_wall_faces(const Mesh& object, const SurfaceSearch& other, double max_distance);

}  // namespace ostraka
