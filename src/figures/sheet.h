// A drawing sheet that is written as an SVG, a PDF or a PNG file.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/render/picture.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

struct _cairo;          // NOLINT(bugprone-reserved-identifier): the name that cairo gives it
struct _cairo_surface;  // NOLINT(bugprone-reserved-identifier)

namespace ostraka::figures {

/// Size of text, and margin of a sheet, in points.
inline constexpr double text_size = 13, margin = 14;
/// Colours of text and axes, of grid lines, of secondary lines and of the background.
inline constexpr Rgb ink{30, 30, 30}, pale{222, 222, 222}, quiet_line{150, 150, 150}, paper{255, 255, 255};

/// Colours that colour-blind readers can distinguish (Okabe and Ito), followed by further colours.
Rgb series_colour(std::size_t index);
/// The colour mixed with the paper colour: 0 is the colour, 1 is paper.
Rgb lighter(const Rgb& colour, double fraction);

/// A rectangle on the sheet.
struct Box {
    double left = 0, top = 0, right = 0, bottom = 0;    ///< sides of the rectangle
    [[nodiscard]] bool meets(const Box& other) const {  ///< true if the rectangles overlap
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
};

/// A drawing surface. Lengths are in points of the SVG, and y points downwards.
class Sheet {
public:
    enum class Format { svg, png, pdf };
    Sheet(double width, double height, Format format = Format::svg);
    ~Sheet();
    Sheet(const Sheet&) = delete;
    Sheet& operator=(const Sheet&) = delete;

    /// Draws a straight line.
    void line(double x1, double y1, double x2, double y2, const Rgb& colour, double width, bool dashed = false);
    /// Draws a poly-line.
    void polyline(const std::vector<std::array<double, 2>>& places, const Rgb& colour, bool dashed = false, double width = 1.8);
    /// Fills the area inside closed curves by the even-odd rule.
    void fill(const std::vector<std::vector<std::array<double, 2>>>& curves, const Rgb& colour);
    /// Fills a rectangle.
    void rectangle(const Box& box, const Rgb& colour);
    /// Draws the border of a rectangle.
    void frame(const Box& box, const Rgb& colour, double width);
    /// Draws a picture, scaled to the box.
    void image(const Picture& picture, const Box& box);
    /// Draws a filled circle.
    void dot(double x, double y, const Rgb& colour, double radius = 3);
    /// Draws mark number `form`, each with its own shape: dot, square, triangle, rhomb, cross, ring and others. ... ...
    void mark(double x, double y, std::size_t form, const Rgb& colour);

    /// Width of a text in points.
    [[nodiscard]] double width_of(const std::string& words, double size = text_size);
    /// Draws a text with base line y; the fraction `anchor` of its width lies to the left of x.
    void text(const std::string& words, double x, double y, double anchor, double size = text_size, const Rgb& colour = ink);
    /// Draws a text rotated to read upwards; the fraction `anchor` of its length lies below y.
    void upward_text(const std::string& words, double x, double y, double anchor = 0.5, double size = text_size);
    /// The text, shortened with an ellipsis if needed to fit the width.
    [[nodiscard]] std::string fitted(const std::string& words, double width, double size = text_size);

    void clip(const Box& box);  ///< restricts drawing to the box until unclip()
    void unclip();              ///< ends clip()

    /// Ends drawing and returns the bytes of the file. Throws Error (failure) if drawing failed.
    std::string finish();

private:
    void set(const Rgb& colour);
    void stroke(const Rgb& colour, double width, bool dashed);

    Format format_;
    double width_, height_;
    std::string bytes_;
    std::unique_ptr<_cairo_surface, void (*)(_cairo_surface*)> surface_;
    std::unique_ptr<_cairo, void (*)(_cairo*)> context_;
};

/// Writes the output of `draw` in the format given by the file's extension, creating folders.
void write_sheet(const Path& file, const std::function<std::string(Sheet::Format)>& draw);

}  // namespace ostraka::figures
