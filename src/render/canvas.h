// Drawing and text, through cairo.
#pragma once

#include "ostraka/render/picture.h"

#include <cairo.h>

#include <memory>
#include <string>
#include <vector>

namespace ostraka::detail {

/// Text fit for drawing: control characters and marks that turn the writing direction are left out, bytes that are not UTF-8
/// become U+FFFD.
std::string clean_text(const std::string& text);

/// For cairo to write to a std::string.
cairo_status_t append_bytes(void* bytes, const unsigned char* data, unsigned int length);

class Canvas {
public:
    /// Width and height in pixels; of a PDF document one is 1/96 inch.
    Canvas(int width, int height, PictureKind kind = PictureKind::pixels);

    void fill(const Rgb& colour);
    /// Lays pixels (0xAARRGGBB, premultiplied) over the canvas, `columns` by `rows` of them over this width and height.
    void paint(const std::vector<std::uint32_t>& pixels, int columns, int rows, int left, int top, int width, int height);

    void clip(double left, double top, double width, double height);
    void unclip();

    struct Place {
        double x, y;
    };
    void polyline(const std::vector<Place>& places, const Rgb& colour, double width);
    void dashed(const std::vector<Place>& places, const Rgb& colour, double width);
    void polygon(const std::vector<Place>& places, const Rgb& colour);
    void disc(Place centre, double radius, const Rgb& colour);
    void rectangle(double left, double top, double width, double height, const Rgb& colour);

    enum class Align { left, centre, right };
    /// Text on the base line `y`; with a `halo` of that colour around the letters if given.
    void text(const std::string& words, double x, double y, double size, const Rgb& colour, Align align = Align::left,
              const Rgb* halo = nullptr);
    /// Upward text, centred at (x, y).
    void upward_text(const std::string& words, double x, double y, double size, const Rgb& colour);
    double text_width(const std::string& words, double size);
    /// The text, or as much of it as fits into `width` with an ellipsis behind.
    std::string elide(const std::string& words, double size, double width);

    /// The finished picture, of a canvas of pixels. Throws Error (failure) if cairo failed at some step.
    Picture picture();
    /// The finished file, of a document. The same drawing has the same bytes. Throws as `picture`; nothing is drawn after it.
    std::string document();

private:
    void check() const;
    void colour(const Rgb& value);
    void trace(const std::vector<Place>& places);
    PictureKind kind_;
    std::unique_ptr<std::string> bytes_;  ///< of a document: where cairo writes to
    std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
    std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace ostraka::detail
