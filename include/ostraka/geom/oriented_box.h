// Oriented bounding box of points.
#pragma once

#include <array>
#include <vector>

namespace ostraka {

/// A box of any orientation.
struct OrientedBox {
    std::array<double, 3> centre{};  ///< centre of the box
    /// Unit vectors along the sides, longest side first, right-handed.
    std::array<std::array<double, 3>, 3> axes{};
    std::array<double, 3> sides{};  ///< lengths of the sides, descending
    [[nodiscard]] double volume() const { return sides[0] * sides[1] * sides[2]; }
};

/// Computes a bounding box of small volume. For each of a fixed set of directions (including the principal axes) the smallest
/// bounding rectangle perpendicular to the direction is computed (rotating calipers, Toussaint 1983). The boxes of smallest
/// volume are then refined. The volume is close to, but not always equal to, the minimum. Without points, all sides have length
/// 0.
OrientedBox oriented_box(const std::vector<std::array<double, 3>>& points);

}  // namespace ostraka
