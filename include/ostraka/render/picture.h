// Pictures: pixels in memory, written as PNG files.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// An opaque sRGB colour; each component is 0 to 255.
struct Rgb {
    std::uint8_t red = 0, green = 0, blue = 0;
    friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Pixels of a picture, rows from the top; each pixel is 0xAARRGGBB with the colour premultiplied by alpha.
struct Picture {
    int width = 0, height = 0;        ///< pixels
    std::vector<std::uint32_t> argb;  ///< pixels, row by row

    /// Pixel in this column and row.
    [[nodiscard]] std::uint32_t at(int column, int row) const {
        return argb[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
    }
};

/// Picture with 16 bits per channel, not premultiplied; rows from the top.
struct DeepPicture {
    int width = 0, height = 0;                       ///< pixels
    std::vector<std::array<std::uint16_t, 4>> rgba;  ///< red, green, blue, alpha of each pixel
};

/// Output format: pixels (PNG) or a vector document (SVG, PDF).
enum class PictureKind { pixels, svg, pdf };

/// The format that the extension of a file name determines: .png, .svg, .pdf. Throws Error (usage) for any other extension.
PictureKind picture_kind(const std::string& file);

/// Renumbers the identifiers in an SVG text written by cairo from 1, because cairo's numbers depend on earlier pictures of the
/// process.
std::string stable_svg(const std::string& svg);

/// Parses a colour: "#rrggbb", "white", "black" or "grey". Throws Error (usage) for any other text.
Rgb parse_colour(const std::string& text);

/// Writes a PNG file atomically. `pixels_per_metre`: resolution on paper, written as a pHYs chunk (PNG, third edition, 11.3.4.3);
/// 0: unstated. Throws Error (failure) if memory runs out.
void write_png(const Path& file, const Picture& picture, double pixels_per_metre = 0);
/// Writes a PNG file with 16 bits per channel atomically; otherwise like the function above.
void write_png(const Path& file, const DeepPicture& picture, double pixels_per_metre = 0);

}  // namespace ostraka
