// Overlay of the shaded surface: lines, markers, legend, colour bar and scale bar.
#pragma once

#include "ostraka/render/colour_scale.h"
#include "render/camera.h"
#include "render/canvas.h"
#include "render/surface.h"

#include <optional>
#include <vector>

namespace ostraka::detail {

/// Colours and sizes of the overlay.
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
    /// For each point, the start of the ray to the viewer; empty: slightly above the point.
    std::vector<Eigen::Vector3d> sight = {};
};
/// Throws Error (input) for a coordinate that is not finite.
std::vector<Line> lines_of(const Scene& scene, const Surface& surface);

/// Whether the ray from the point, or from slightly above it, to the viewer is free.
bool in_sight(const Surface& surface, const Camera& camera, const Eigen::Vector3d& point);

struct LineDrawing {
    double size = 1;      ///< pixels per nominal pixel
    double shortest = 0;  ///< minimum length of visible intervals, in pixels
    double bridged = 0;   ///< hidden intervals between visible ones that are shorter than this, in pixels, are drawn
    double thinning = 0;  ///< simplification tolerance, in pixels
};
/// Draws the visible intervals of the lines, and, for lines with `through`, the hidden intervals dashed.
void draw_lines(Canvas& canvas, const std::vector<Line>& lines, const Surface& surface, const Camera& camera,
                const LineDrawing& drawing);
/// Draws the visible markers and returns their number.
std::size_t draw_markers(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, const Style& style);

/// Draws the directions of the mesh's axes in the lower right corner of this pane.
void draw_axes(Canvas& canvas, const PixelBox& pane, const Camera& camera, const Style& style);

/// Draws a bar of `pixels` on the line `y`, with its length above.
void draw_scale_bar(Canvas& canvas, double x, double y, double pixels, const std::string& text, const Style& style);

/// The column beside the picture: legend above, colour bar below.
class SideColumn {
public:
    SideColumn(Canvas& canvas, std::vector<LegendEntry> legend, std::optional<ColourScale> scale, double width_limit,
               double height, const Style& style);
    [[nodiscard]] double width() const { return width_; }  ///< including margins; 0 if there is nothing to show
    void draw(double left, double top) const;

private:
    void draw_legend(double left, double top) const;
    void draw_colour_bar(double left, double top) const;

    Canvas& canvas_;
    std::vector<LegendEntry> legend_;
    std::size_t omitted_ = 0;  ///< number of entries without room
    std::optional<ColourScale> scale_;
    std::vector<double> ticks_;
    std::vector<std::string> tick_texts_;
    Style style_;
    double width_ = 0, height_ = 0, font_ = 0, legend_height_ = 0, tick_width_ = 0;
};

}  // namespace ostraka::detail
