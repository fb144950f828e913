// Rings of the wall of a vessel, of which diameters are reported: at the top of the lip, and where the wall is widest.
#pragma once

#include "axis/revolution_posterior.h"

#include <vector>

namespace ostraka::detail {

/// A ring of the wall: cells near one height of the profile.
struct WallRing {
    std::vector<std::size_t> cells;  ///< cells near the ring
    double correction = 0;           ///< radius of the ring minus mean radius of the cells, about the best axis
    double error = 0;                ///< standard error of the radius of the ring from noise and from the place of its top
    double height = 0;               ///< height, from -1 to 1 at the ends of the wall
    bool rim = false;                ///< true: top of a lip, the end of a wall
    double share = 0;                ///< share of the circumference over which the ring is preserved
};
/// The ring at the top of a lip, if there is one; otherwise the widest ring of the walls.
WallRing diameter_ring(const RevolutionPosterior& posterior);
/// The widest ring of the walls.
WallRing widest_ring(const RevolutionPosterior& posterior);
/// Diameter of the circle of the vessel at a ring, for each sample of the posterior; a negative curvature gives an infinite one.
std::vector<double> ring_diameters(const RevolutionPosterior& posterior, const WallRing& ring);

}  // namespace ostraka::detail
