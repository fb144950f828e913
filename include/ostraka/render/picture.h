// Pictures: pixels in memory, written as PNG files.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// An opaque colour, sRGB, 0 to 255.
struct Rgb {
    std::uint8_t red = 0, green = 0, blue = 0;
    friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Rows from the top, each pixel 0xAARRGGBB with the colour premultiplied by alpha.
struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint32_t> argb;

    [[nodiscard]] std::uint32_t at(int column, int row) const {
        return argb[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
    }
};

/// 16 bits per channel, not premultiplied: red, green, blue, alpha of each pixel, rows from the top.
struct DeepPicture {
    int width = 0, height = 0;
    std::vector<std::array<std::uint16_t, 4>> rgba;
};

/// Output format: pixels, or a vector document whose lines and letters stay sharp at any size.
enum class PictureKind { pixels, svg, pdf };

/// Determined by the extension: .png, .svg, .pdf. Throws Error (usage) for any other extension.
PictureKind picture_kind(const std::string& file);

/// The SVG written by cairo with the numbers in its identifiers renumbered from 1: cairo counts over the whole process.
std::string stable_svg(const std::string& svg);

/// "#rrggbb", "white", "black" or "grey". Throws Error (usage) for anything else.
Rgb parse_colour(const std::string& text);

/// Writes a PNG file atomically. Throws Error (failure) if memory runs out.
void write_png(const Path& file, const Picture& picture);
/// The same with 16 bits per channel.
void write_png(const Path& file, const DeepPicture& picture);

}  // namespace ostraka
