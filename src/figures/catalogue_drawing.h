// Drawings of catalogue entries on a sheet, at a scale.
#pragma once

#include "figures/sheet.h"

#include "ostraka/catalogue/entry.h"
#include "ostraka/figures/catalogue.h"

namespace ostraka::figures {

/// PlateExtent of a drawing on paper, in points, around its origin: the axis (or the left end) at the lowest point.
struct PlateExtent {
    double left = 0, right = 0, above = 0, below = 0;
    [[nodiscard]] double width() const { return left + right; }
    [[nodiscard]] double height() const { return above + below; }
};

/// Room around drawings for dimensions and scale bars.
inline constexpr double above_drawing = 30, below_drawing = 32, beside_drawing = 22;

/// Draws a vessel or sherd about its axis. `scale`: paper length per length.
class PotteryPlate {
public:
    PotteryPlate(const CatalogueEntry& entry, const CatalogueStyle& style, double scale);
    /// PlateExtent without dimensions.
    [[nodiscard]] PlateExtent extent() const;
    /// Draws with the axis at x and the lowest point at y; `compact`: without dimension lines.
    void draw(Sheet& sheet, double x, double y, bool compact) const;

private:
    void draw_outside(Sheet& sheet) const;
    void draw_lines(Sheet& sheet) const;
    void draw_section(Sheet& sheet) const;
    void draw_dimensions(Sheet& sheet) const;
    [[nodiscard]] bool reconstructs() const;
    [[nodiscard]] double paper_x(double x) const { return x_ + side_ * points_ * x; }
    [[nodiscard]] double paper_y(double y) const { return y_ - points_ * y; }
    [[nodiscard]] std::vector<std::array<double, 2>> on_paper(const std::vector<Vector2d>& curve, bool closed) const;

    const CatalogueEntry& entry_;
    const CatalogueStyle& style_;
    double points_;                 ///< points per millimetre of the object
    double side_ = 1;               ///< -1: the section is on the right
    double apart_ = 0;              ///< points between section and outside view, if no axis is drawn
    mutable double x_ = 0, y_ = 0;  ///< place of the origin
};

/// Draws a view with its picture, outline and landmarks: its lower left corner (of the object) at x, y.
void draw_view(Sheet& sheet, const CatalogueView& view, double points, double x, double y);

/// "1:2", "2:1", "1:2.5".
std::string scale_text(double scale);
/// "24.6 mm"; lengths from 100 mm on without decimals.
std::string millimetres_text(double value);
/// "246 mm (238 to 255)" or what is known of it.
std::string diameter_text(const CatalogueDiameter& diameter);
/// The preserved share of a circle: "12 %".
std::string share_text(double share);

}  // namespace ostraka::figures
