// Warped bodies: horizontal sections of a solid are shifted, and the surface is displaced radially from the centres of the
// sections.
#pragma once

#include "synthetic/spline.h"

#include "ostraka/synthetic/solid.h"

#include <memory>
#include <vector>

namespace ostraka::shapes {

/// A wave over the angle a and the height z: amplitude cos(around a + upward z + phase).
struct Wave {
    double amplitude = 0;  ///< amplitude of the wave
    int around = 0;        ///< number of periods per turn
    double upward = 0;     ///< wave number along the height, radians per unit of length
    double phase = 0;      ///< radians
};

/// Value of a sum of waves at an angle and a height, and the derivatives by angle and height.
struct WaveSum {
    double value = 0, by_angle = 0, by_height = 0;
};
/// Evaluates a sum of waves at an angle and a height.
WaveSum sum_of(const std::vector<Wave>& waves, double angle, double height);

/// Warp of an upright body. At height z (clamped to [low, high]) the centre of the section is `offset` + sums of waves over the
/// height, and the surface at angle a is displaced outwards by `size` times the sum of the relative waves plus the sum of the
/// absolute waves.
struct Warp {
    double low = 0, high = 0;                          ///< height range of the warp
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< constant shift of the centres
    std::vector<Wave> centre_x, centre_y;              ///< waves of the centre's coordinates, as lengths; `around` is ignored
    Spline<1> size;                        ///< length by which the relative waves are multiplied, as a function of the height
    std::vector<Wave> relative, absolute;  ///< waves of the displacement, relative to `size` and as lengths
    /// Distance from the centre within which the displacement fades out, so that the axis remains a single curve.
    double core = 1;

    /// Centre of the section at a height.
    [[nodiscard]] Eigen::Vector2d centre(double height) const;
    /// Outward displacement of the surface at an angle and a height.
    [[nodiscard]] double displacement(double angle, double height) const;
};

/// The warped solid. The value at a point is the value of `solid` at the preimage of the point, scaled so that its slope is at
/// most 1 (the max slope of the warp is sampled, with a margin).
SolidPointer make_warped(SolidPointer solid, std::shared_ptr<const Warp> warp);

/// The part of a solid below the plane at this height.
SolidPointer make_below(SolidPointer solid, double height);

}  // namespace ostraka::shapes
