// Heights along an axis and directions across it.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"

#include <cmath>

namespace ostraka {

/// Everything in the frame of the axis: height along it, directions across it.
struct AxisFrame {
    Eigen::Vector3d foot = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ(), u = Eigen::Vector3d::UnitX(),
                    w = Eigen::Vector3d::UnitY();
    [[nodiscard]] double height(const Eigen::Vector3d& p) const { return (p - foot).dot(up); }
    [[nodiscard]] Eigen::Vector3d across(const Eigen::Vector3d& p) const { return p - foot - height(p) * up; }
    [[nodiscard]] Eigen::Vector3d direction(double angle) const { return std::cos(angle) * u + std::sin(angle) * w; }
};

AxisFrame frame_of(const Axis& axis);

}  // namespace ostraka
