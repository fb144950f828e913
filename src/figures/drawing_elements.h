// Elements shared by drawings of slices and of profiles.
#pragma once

#include "figures/sheet.h"

#include "ostraka/slicing/slice.h"

namespace ostraka::figures {

/// Colours of material, of open contours, of guide lines and of secondary text.
inline constexpr Rgb clay_fill{222, 196, 166}, torn{213, 94, 0}, guide{0, 114, 178}, quiet{150, 150, 150};

/// Mapping from the plane of a drawing, where y points upwards, to the sheet.
struct Placing {
    double scale = 1;     ///< points of the sheet per unit of length in the drawing
    double x = 0, y = 0;  ///< position of the drawing's origin on the sheet
    [[nodiscard]] std::array<double, 2> operator()(const Eigen::Vector2d& p) const {
        return {x + scale * p.x(), y - scale * p.y()};
    }
    [[nodiscard]] std::vector<std::array<double, 2>> operator()(const std::vector<Eigen::Vector2d>& points, bool closed) const;
};

/// Draws a scale bar of a round length, at most `maximum` points long, alternately white and black, with numbers; its left end is
/// at x.
void scale_bar(Sheet& sheet, double x, double y, double scale, double maximum, const std::string& unit);

/// Text of a length with its unit, rounded to the precision of a drawing.
std::string length_text(double value, const std::string& unit);

/// Draws the open contours of a slice, with a ring at each end.
void open_contours(Sheet& sheet, const Slice& slice, const Placing& placing);

}  // namespace ostraka::figures
