// Oriented bounding box of points.
#pragma once

#include <array>
#include <vector>

namespace ostraka {

struct OrientedBox {
    std::array<double, 3> centre{};
    std::array<std::array<double, 3>, 3> axes{};  ///< unit vectors, longest side first, right-handed
    std::array<double, 3> sides{};
    [[nodiscard]] double volume() const { return sides[0] * sides[1] * sides[2]; }
};

/// A small bounding box of the points: the smallest rectangle (rotating calipers, Toussaint 1983) for each of a fixed set of
/// directions, which includes the principal axes; the best ones are refined. Close to the minimum-volume box, but not always
/// equal. Sides of length 0 if there are no points.
OrientedBox oriented_box(const std::vector<std::array<double, 3>>& points);

}  // namespace ostraka
