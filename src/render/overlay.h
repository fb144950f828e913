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

/// A line in the surface's own coordinates.
struct Line {
    std::vector<Eigen::Vector3d> points;
    Rgb colour;
    double width = 1;  ///< nominal pixels
    bool cased = false, through = false;
    std::vector<Eigen::Vector3d> sight = {};  ///< of each point where the ray to the viewer starts; empty: a little above it
};
/// Throws Error (input) for a coordinate that is not finite.
std::vector<Line> lines_of(const Scene& scene, const Surface& surface);

/// Whether nothing lies between the point, or a little above it, and the viewer.
bool in_sight(const Surface& surface, const Camera& camera, const Eigen::Vector3d& point);

struct LineDrawing {
    double size = 1;      ///< pixels per nominal pixel
    double shortest = 0;  ///< stretches of fewer pixels are left out
    double bridged = 0;   ///< hidden stretches of fewer pixels between others are drawn
    double thinning = 0;  ///< corners are left out that lie no farther from the line than this, in pixels
};
/// Draws the stretches of the lines that are in sight, and dashed the hidden ones of those that go through.
void draw_lines(Canvas& canvas, const std::vector<Line>& lines, const Surface& surface, const Camera& camera,
                const LineDrawing& how);
/// Draws the markers that are in sight and returns their number.
std::size_t draw_markers(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, const Style& style);

/// The directions of the mesh's axes, in the lower right corner of this pane.
void draw_axes(Canvas& canvas, const PixelBox& pane, const Camera& camera, const Style& style);

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
