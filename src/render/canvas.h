// Draws shapes and text, through cairo.
#pragma once

#include "ostraka/render/picture.h"

#include <cairo.h>

#include <memory>
#include <string>
#include <vector>

namespace ostraka::detail {

/// The text made safe to draw: removes control characters and bidirectional formatting characters, and replaces bytes that are
/// not UTF-8 by U+FFFD.
std::string clean_text(const std::string& text);

/// Write function for cairo; `bytes` points to the std::string to which the data are appended.
cairo_status_t append_bytes(void* bytes, const unsigned char* data, unsigned int length);

inline constexpr double css_dpi = 96;  ///< pixels per inch of a document of which nothing else is stated

class Canvas {
public:
    /// Width and height in pixels; in a document a pixel is 1/dpi inch.
    Canvas(int width, int height, PictureKind kind = PictureKind::pixels, double dpi = css_dpi);

    void fill(const Rgb& colour);  ///< fills the canvas with one colour
    /// Draws an image over the canvas: `columns` by `rows` pixels (0xAARRGGBB, premultiplied), scaled to this width and height.
    void paint(const std::vector<std::uint32_t>& pixels, int columns, int rows, int left, int top, int width, int height);

    /// Restricts drawing to a rectangle until `unclip`.
    void clip(double left, double top, double width, double height);
    void unclip();  ///< removes the restriction

    struct Place {
        double x, y;
    };
    void polyline(const std::vector<Place>& places, const Rgb& colour, double width);  ///< draws a line through the places
    void dashed(const std::vector<Place>& places, const Rgb& colour, double width);    ///< draws a dashed line through the places
    void polygon(const std::vector<Place>& places, const Rgb& colour);                 ///< fills a polygon
    void disc(Place centre, double radius, const Rgb& colour);                         ///< fills a disc
    void rectangle(double left, double top, double width, double height, const Rgb& colour);  ///< fills a rectangle

    enum class Align { left, centre, right };
    /// Draws text with its base line at `y`; `halo`: colour of an outline around the letters, or null.
    void text(const std::string& words, double x, double y, double size, const Rgb& colour, Align align = Align::left,
              const Rgb* halo = nullptr);
    /// Draws text rotated to read upwards, centred at (x, y).
    void upward_text(const std::string& words, double x, double y, double size, const Rgb& colour);
    double text_width(const std::string& words, double size);  ///< width of a text in pixels
    /// The text, shortened with an ellipsis to be at most `width` wide.
    std::string elide(const std::string& words, double size, double width);

    /// The finished picture of a pixel canvas. Throws Error (failure) if cairo reported an error.
    Picture picture();
    /// The finished file of an SVG or PDF canvas; the same drawing gives the same bytes. Throws the errors of `picture`. Nothing
    /// can be drawn afterwards.
    std::string document();

private:
    void check() const;                            ///< throws Error (failure) if cairo reported an error
    void colour(const Rgb& value);                 ///< sets the colour for drawing
    void trace(const std::vector<Place>& places);  ///< makes a poly-line the current path
    PictureKind kind_;
    std::unique_ptr<std::string> bytes_;  ///< output buffer of cairo for SVG and PDF
    std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
    std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace ostraka::detail
