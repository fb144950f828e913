// Decoders and encoders of single formats.
#pragma once

#include "image/header.h"

namespace ostraka::images {

Pixels decode_png(std::string_view bytes, const Header& header, const Place& place);
Pixels decode_jpeg(std::string_view bytes, const Header& header, const Place& place);
Pixels decode_webp(std::string_view bytes, const Header& header, const Place& place);
Pixels decode_gif(std::string_view bytes, const Header& header, const Place& place);

/// Image files in memory. Throw Error (failure) if the library fails.
std::string encode_png(const Pixels& pixels);
std::string encode_jpeg(const Pixels& pixels, int quality);
std::string encode_webp(const Pixels& pixels, int quality);

/// Pixels of this size, all 0.
Pixels blank_pixels(int width, int height);
/// True if a pixel has an alpha below 255.
bool is_translucent(const Pixels& pixels);

}  // namespace ostraka::images
