// What drawings of slices and of profiles share.
#pragma once

#include "sheet.h"

#include "ostraka/slicing/slice.h"

namespace ostraka::report {

inline constexpr Rgb clay{222, 196, 166}, torn{213, 94, 0}, guide{0, 114, 178}, quiet{150, 150, 150};

/// From the plane of a drawing onto the sheet, y upward.
struct Placing {
    double scale = 1;     ///< points of the sheet a unit
    double x = 0, y = 0;  ///< where (0, 0) lies
    [[nodiscard]] std::array<double, 2> operator()(const Eigen::Vector2d& p) const {
        return {x + scale * p.x(), y - scale * p.y()};
    }
    [[nodiscard]] std::vector<std::array<double, 2>> operator()(const std::vector<Eigen::Vector2d>& points, bool closed) const;
};

/// A bar of a round length, at most `maximum` points long, white and black by turns, with its numbers; its left end at x.
void scale_bar(Sheet& sheet, double x, double y, double scale, double maximum, const std::string& unit);

/// A length with as many digits as a drawing bears, and its unit.
std::string length_text(double value, const std::string& unit);

/// Open contours as they are, with a ring at each end.
void open_contours(Sheet& sheet, const Slice& slice, const Placing& placing);

}  // namespace ostraka::report
