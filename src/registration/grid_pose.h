// Scores and refines poses of points on a surface, using a grid of nearest points of the surface, for searches over many poses.
#pragma once

#include "registration/nearest_grid.h"

#include "ostraka/geom/rigid_fit.h"

#include <cmath>

namespace ostraka::detail {

/// At most `count` of the points, evenly chosen from the list.
SurfacePoints thinned(const SurfacePoints& points, std::size_t count);

/// Nearness of a point at a given distance, 1 to 0, on a logarithmic scale.
struct Nearness {
    double low, high;  ///< distances at which the nearness is 1 and 0
    explicit Nearness(double tolerance) : low(0.25 * tolerance), high(2.5 * tolerance) {}
    /// Nearness of a point at this distance.
    [[nodiscard]] double operator()(double distance) const {
        return distance >= high ? 0 : distance <= low ? 1 : std::log(high / distance) / std::log(high / low);
    }
};

/// Mean nearness of the moved points of `part` to the surface; a point whose normal differs by more than 60 degrees counts 0.
double score_on(const NearestGrid& grid, const SurfacePoints& part, const Motion& pose, const Nearness& near);

/// Pose refined by ICP, point to plane, on the grid, with a search radius that falls to 1.5 times the tolerance; `scale`: true to
/// refine the scale as well.
Motion refined_on(const NearestGrid& grid, const SurfacePoints& part, Motion pose, double tolerance, int rounds, bool scale);

}  // namespace ostraka::detail
