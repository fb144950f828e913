// Image files (JPEG, PNG, WebP, GIF) and their pixels.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

enum class ImageFormat { png, jpeg, webp, gif };

/// Media type (RFC 6838) of a format, such as "image/png".
std::string media_type(ImageFormat format);
/// File extension of a format with its dot, such as ".png".
std::string extension_of(ImageFormat format);

/// An image file in memory. Its bytes are decoded only if pixels are needed, and are written to other files unchanged.
struct Image {
    std::string name;                       ///< file name without folder, or name in the file that contains it; may be empty
    std::string bytes;                      ///< content of the image file
    ImageFormat format = ImageFormat::png;  ///< format, determined from the content and not from the file name
    int width = 0, height = 0;              ///< pixels
};
using SharedImage = std::shared_ptr<const Image>;

/// Largest width and height of an image, and largest number of its pixels: larger images are refused before they are decoded.
inline constexpr int max_image_side = 32768;
inline constexpr std::int64_t max_image_pixels = std::int64_t{1} << 28;

/// Makes an Image from the bytes of an image file; only the header is parsed. `where`: file for messages. Throws Error (input)
/// if the bytes are not a JPEG, PNG, WebP or GIF file (the message names the format if it is KTX2, TIFF, BMP, TGA, DDS or
/// Basis), if the header is damaged, or if the image exceeds the limits above.
Image parse_image(std::string bytes, const std::string& name, const std::string& where);
/// Reads an image file. Throws Error (input) as parse_image does.
Image read_image(const Path& file);

/// Pixels of an image: sRGB colours with straight alpha, rows from the top.
struct Pixels {
    int width = 0, height = 0;                      ///< number of columns and rows
    std::vector<std::array<std::uint8_t, 4>> rgba;  ///< red, green, blue, alpha of each pixel, row by row

    /// Pixel in this column and row.
    [[nodiscard]] const std::array<std::uint8_t, 4>& at(int column, int row) const {
        return rgba[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
    }
};

/// Decodes an image. Supported are greyscale images, palettes, 16 bits per channel (rounded to 8), interlaced PNG, progressive
/// and CMYK JPEG (also Adobe's inverted CMYK), and the first picture of a GIF. Colour profiles and orientation tags are
/// ignored, as mesh viewers ignore them in textures. Throws Error (input), naming `where`, if the bytes are truncated.
Pixels decode(const Image& image, const std::string& where);

/// Encodes pixels as an image file in memory. `quality` (1 to 100) is for JPEG and WebP (100: lossless WebP); JPEG drops alpha.
/// Throws Error (usage) for GIF, and if the number of pixels is not width times height.
Image encode(const Pixels& pixels, ImageFormat format, const std::string& name, int quality = 90);

/// Reduces an image to `width` x `height` pixels by area averages in linear light, colours weighted by alpha. Throws Error
/// (usage) unless 1 <= width <= pixels.width, likewise for the height.
Pixels reduced(const Pixels& pixels, int width, int height);

/// Returns an image whose longer side is at most `max_side` pixels and whose file has at most `max_bytes` bytes. An image
/// within these limits is returned unchanged. Otherwise the image is reduced and encoded again (as JPEG, or as PNG if a pixel
/// is translucent), first with decreasing quality (90 to 60), then with decreasing size.
Image within_budget(const Image& image, int max_side, std::size_t max_bytes, const std::string& where);

}  // namespace ostraka
