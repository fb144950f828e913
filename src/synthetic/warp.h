// Warped bodies: horizontal sections of a solid are shifted, and the surface is displaced radially from their centres.
#pragma once

#include "synthetic/spline.h"

#include "ostraka/synthetic/solid.h"

#include <memory>
#include <vector>

namespace ostraka::shapes {

/// amplitude cos(around a + upward z + phase): a wave over the angle a and the height z.
struct Wave {
    double amplitude = 0;
    int around = 0;     ///< periods per turn
    double upward = 0;  ///< radians per unit of height
    double phase = 0;
};

/// Value of a sum of waves at an angle and a height, and its derivatives.
struct WaveSum {
    double value = 0, by_angle = 0, by_height = 0;
};
WaveSum sum_of(const std::vector<Wave>& waves, double angle, double height);

/// Warp of an upright body. At height z (clamped to [low, high]) the centre is `offset` + sums of waves over the height, and
/// the surface at angle a is displaced outwards by `size` times the relative waves plus the absolute waves.
struct Warp {
    double low = 0, high = 0;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();
    std::vector<Wave> centre_x, centre_y;  ///< in units of length; `around` is ignored
    Spline<1> size;                        ///< reference of the relative waves, over the height
    std::vector<Wave> relative, absolute;
    double core = 1;  ///< within this distance of the centre the displacement fades out, so that the axis remains a single curve

    [[nodiscard]] Eigen::Vector2d centre(double height) const;
    /// Outward displacement of the surface.
    [[nodiscard]] double displacement(double angle, double height) const;
};

/// The warped solid. The value is that of `solid` at the preimage, scaled so that its slope is at most 1 (the maximum slope of
/// the warp is sampled, with a margin).
SolidPointer make_warped(SolidPointer solid, std::shared_ptr<const Warp> warp);

/// The part of a solid below a height.
SolidPointer make_below(SolidPointer solid, double height);

}  // namespace ostraka::shapes
