// How one surface lies on another: how far it is off, how much of it, and which regions.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <string>
#include <vector>

namespace ostraka {

/// A connected region of a surface that does not lie on another one.
struct OffRegion {
    double share = 0;               ///< of the surface's area
    Point middle{0, 0, 0};          ///< mean of the region's points
    double farthest = 0;            ///< of its points from the other surface, in the mesh's unit
    Point at{0, 0, 0};              ///< the farthest point
    Index face = no_index;          ///< of the surface, that the point is on
    Index nearest_face = no_index;  ///< of the other surface, nearest to that point
    std::string part;               ///< annotations of the template there, in words; empty where there are none
};

struct SurfaceOff {
    double distance = 0;             ///< root mean square to the other surface, in the mesh's unit
    double share = 0;                ///< of the area that is off
    std::vector<OffRegion> regions;  ///< largest first, those of one per cent of the area or more
};

/// Points spread evenly over the faces, at most 5000, each off if it is farther than `near` from the other surface, or nothing
/// within that distance of the other has a normal within 60 degrees of its own. Faces without a point are off as the nearest one
/// with a point is, counted in steps from face to face.
SurfaceOff surface_off(const Mesh& mesh, const SurfaceSearch& other, double near);

/// The faces of an object that are the inside of walls whose outside lies on the other surface: those off it as above whose
/// normal is turned away from that of the other surface at the nearest place, where this place in turn lies on the object. One
/// flag a face; connected regions of less than one per cent of the area do not count.
std::vector<bool> insides_of_walls(const Mesh& object, const SurfaceSearch& other, double near);

}  // namespace ostraka
