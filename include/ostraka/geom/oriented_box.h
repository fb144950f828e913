// A small box of any orientation around points.
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

/// A small box around the points: the smallest rectangle (rotating calipers, Toussaint 1983) over a fixed set of directions,
/// principal axes among them, the best refined. Near the smallest box, not always it. Null sides without points.
OrientedBox oriented_box(const std::vector<std::array<double, 3>>& points);

}  // namespace ostraka
