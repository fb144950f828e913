// Bodies that are not quite round: a solid whose horizontal sections are moved and whose surface is moved towards or away from
// their centres.
#pragma once

#include "spline.h"

#include "ostraka/synthetic/solid.h"

#include <memory>
#include <vector>

namespace ostraka::shapes {

/// amplitude cos(around a + upward z + phase): a wave over the angle a and the height z.
struct Wave {
    double amplitude = 0;
    int around = 0;     ///< periods in a turn
    double upward = 0;  ///< radians per unit of height
    double phase = 0;
};

/// Value of a sum of waves at an angle and a height, and its derivatives.
struct WaveSum {
    double value = 0, by_angle = 0, by_height = 0;
};
WaveSum sum_of(const std::vector<Wave>& waves, double angle, double height);

/// What moves the points of an upright body: at height z (kept within [low, high]) the centre stands at `offset` + sums of waves
/// of the height, and the surface at angle a stands farther out by `size` times the relative waves plus the absolute waves.
struct Warp {
    double low = 0, high = 0;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();
    std::vector<Wave> centre_x, centre_y;  ///< in units of length; `around` is not used
    Spline<1> size;                        ///< what relative waves are relative to, over the height
    std::vector<Wave> relative, absolute;
    double core = 1;  ///< within this distance of the centre the displacement fades out, so that the axis stays one line

    [[nodiscard]] Eigen::Vector2d centre(double height) const;
    /// Displacement of the surface away from the centre.
    [[nodiscard]] double displacement(double angle, double height) const;
};

/// The solid moved by the warp. The value is that of `solid` at the point moved back, scaled so that it changes by at most 1 a
/// unit of length (the warp's steepest change is taken from samples, with a margin).
SolidPointer make_warped(SolidPointer solid, std::shared_ptr<const Warp> warp);

/// What of a solid lies below a height.
SolidPointer make_below(SolidPointer solid, double height);

}  // namespace ostraka::shapes
