// Overlay of the shaded surface: lines, markers, legend, colour bar and scale bar.
#pragma once

#include "ostraka/render/colour_scale.h"
#include "render/camera.h"
#include "render/canvas.h"
#include "render/surface.h"

#include <optional>
#include <vector>

namespace ostraka::detail {

/// Colours of the overlay, and scale of its lines and letters.
struct Style {
    double size = 1;      ///< pixels per nominal pixel; in a picture 900 pixels high it is 1
    Rgb ink{45, 45, 48};  ///< colour of text and lines
    Rgb background{255, 255, 255};
};

/// A line in the surface's own coordinates.
struct Line {
    std::vector<Eigen::Vector3d> points;  ///< successive points of the line
    Rgb colour;
    double width = 1;                     ///< width in nominal pixels
    bool cased = false, through = false;  ///< drawn with a dark outline; hidden intervals are drawn dashed
    /// For each point, the start of the ray to the viewer that decides visibility; empty: slightly above the point.
    std::vector<Eigen::Vector3d> sight = {};
};
/// The lines of a scene. Throws Error (input) for a coordinate that is not finite.
std::vector<Line> lines_of(const Scene& scene, const Surface& surface);

/// Whether the ray to the viewer from the point, or from slightly above the point, is unobstructed.
bool is_visible(const Surface& surface, const Camera& camera, const Eigen::Vector3d& point);

/// How lines are drawn.
struct LineDrawing {
    double size = 1;      ///< pixels per nominal pixel
    double shortest = 0;  ///< min length of a visible interval that is drawn, in pixels
    double bridged = 0;   ///< max length of a hidden interval between two visible intervals that is drawn nevertheless, in pixels
    double thinning = 0;  ///< max deviation of the simplified line, in pixels
};
/// Draws the visible intervals of the lines, and for lines with `through` the hidden intervals dashed.
void draw_lines(Canvas& canvas, const std::vector<Line>& lines, const Surface& surface, const Camera& camera,
                const LineDrawing& drawing);
/// Draws the visible markers and returns their number.
std::size_t draw_markers(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, const Style& style);

/// Draws the directions of the mesh's axes in the lower right corner of the pane.
void draw_axes(Canvas& canvas, const PixelBox& pane, const Camera& camera, const Style& style);

/// Draws a scale bar of `pixels` pixels at the height `y`, with its length as text above.
void draw_scale_bar(Canvas& canvas, double x, double y, double pixels, const std::string& text, const Style& style);

/// The column beside the picture: legend above, colour bar below.
class SideColumn {
public:
    SideColumn(Canvas& canvas, std::vector<LegendEntry> legend, std::optional<ColourScale> scale, double width_limit,
               double height, const Style& style);
    [[nodiscard]] double width() const { return width_; }  ///< including margins; 0 if there is nothing to show
    void draw(double left, double top) const;              ///< draws the column at this position

private:
    void draw_legend(double left, double top) const;
    void draw_colour_bar(double left, double top) const;

    Canvas& canvas_;
    std::vector<LegendEntry> legend_;
    std::size_t omitted_ = 0;  ///< number of legend entries for which there is no room
    std::optional<ColourScale> scale_;
    std::vector<double> ticks_;            ///< values of the ticks of the colour bar
    std::vector<std::string> tick_texts_;  ///< text of each tick
    Style style_;
    double width_ = 0, height_ = 0, font_ = 0, legend_height_ = 0, tick_width_ = 0;  ///< sizes in pixels; font_: font size
};

}  // namespace ostraka::detail
