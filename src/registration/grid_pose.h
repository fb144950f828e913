// Scores and refines poses of points on a surface with a grid of its points, for searches over many poses.
#pragma once

#include "registration/nearest_grid.h"

#include "ostraka/geom/rigid_fit.h"

#include <cmath>

namespace ostraka::detail {

/// At most `count` of the points, evenly chosen.
SurfacePoints thinned(const SurfacePoints& points, std::size_t count);

/// Nearness score of a distance, on a logarithmic scale.
struct Nearness {
    double low, high;
    explicit Nearness(double tolerance) : low(0.25 * tolerance), high(2.5 * tolerance) {}
    [[nodiscard]] double operator()(double distance) const {
        return distance >= high ? 0 : distance <= low ? 1 : std::log(high / distance) / std::log(high / low);
    }
};

/// Mean nearness of the points to the surface; 0 where normals differ by more than 60 degrees.
double score_on(const NearestGrid& grid, const SurfacePoints& part, const Motion& pose, const Nearness& near);

/// ICP, point to plane, on the grid, with a search radius that falls to 1.5 times the tolerance; with `scale`, the scale is
/// refined too.
Motion refined_on(const NearestGrid& grid, const SurfacePoints& part, Motion pose, double tolerance, int rounds, bool scale);

}  // namespace ostraka::detail
