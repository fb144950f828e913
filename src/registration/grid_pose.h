// How well points lie on a surface in a pose, and the pose improved, by a grid of the surface's points: for the many poses of a
// search.
#pragma once

#include "nearest_grid.h"

#include "ostraka/geom/rigid_fit.h"

#include <cmath>

namespace ostraka::detail {

/// At most `count` of the points, evenly chosen.
SurfacePoints thinned(const SurfacePoints& points, std::size_t count);

/// How near is near, on a logarithmic scale.
struct Nearness {
    double low, high;
    explicit Nearness(double tolerance) : low(0.25 * tolerance), high(2.5 * tolerance) {}
    [[nodiscard]] double operator()(double distance) const {
        return distance >= high ? 0 : distance <= low ? 1 : std::log(high / distance) / std::log(high / low);
    }
};

/// Mean over the points of how near they lie to the surface's; 0 where normals differ by more than 60 degrees.
double score_on(const NearestGrid& grid, const SurfacePoints& part, const Motion& pose, const Nearness& near);

/// Iterative closest points, point to plane, on the grid, in a search radius that falls to 1.5 times the tolerance; with `scale`
/// that as well.
Motion refined_on(const NearestGrid& grid, const SurfacePoints& part, Motion pose, double tolerance, int rounds, bool scale);

}  // namespace ostraka::detail
