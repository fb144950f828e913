// Lines, markers, legend, colour bar and scale bar: what is drawn over the shaded surface.
#pragma once

#include "camera.h"
#include "canvas.h"
#include "ostraka/render/colour_scale.h"
#include "surface.h"

#include <optional>
#include <vector>

namespace ostraka::detail {

/// Colours and sizes of what is drawn.
struct Style {
    double size = 1;  ///< pixels per nominal pixel
    Rgb ink{45, 45, 48};
    Rgb background{255, 255, 255};
};

/// Draws the stretches of the scene's lines that are in sight.
void draw_lines(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, double size);
/// Draws the markers that are in sight and returns their number.
std::size_t draw_markers(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, const Style& style);

/// A bar of `pixels` on the line `y` with its length written above it.
void draw_scale_bar(Canvas& canvas, double x, double y, double pixels, const std::string& text, const Style& style);

/// The column beside the picture: legend above, colour bar below.
class SideColumn {
public:
    SideColumn(Canvas& canvas, std::vector<LegendEntry> legend, std::optional<ColourScale> scale, double width_limit,
               double height, const Style& style);
    [[nodiscard]] double width() const { return width_; }  ///< with its margins; 0 if there is nothing to show
    void draw(double left, double top) const;

private:
    void draw_legend(double left, double top) const;
    void draw_colour_bar(double left, double top) const;

    Canvas& canvas_;
    std::vector<LegendEntry> legend_;
    std::size_t left_out_ = 0;  ///< entries for which there is no room
    std::optional<ColourScale> scale_;
    std::vector<double> ticks_;
    std::vector<std::string> tick_texts_;
    Style style_;
    double width_ = 0, height_ = 0, font_ = 0, legend_height_ = 0, tick_width_ = 0;
};

}  // namespace ostraka::detail
