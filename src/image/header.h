// The header of an image file, read without any allocation that depends on it.
#pragma once

#include "image/place.h"
#include "ostraka/image/image.h"

#include <string_view>

namespace ostraka::images {

/// What the header of an image file says.
struct Header {
    ImageFormat format = ImageFormat::png;
    int width = 0, height = 0;
};

/// Header of an image file within the limits of size. Throws Error (input) as parse_image does.
Header read_header(std::string_view bytes, const Place& place);

/// Checks, before pixels are allocated, that the pixels (4 bytes each) take at most 16 bytes for each byte of the file and 256
/// MB, that the pixels and the memory of the decoder take at most 16 bytes for each byte of the file and 512 MB, and that the
/// memory limit of this thread suffices. Throws Error.
void require_proportion(const Header& header, std::size_t file_bytes, double decoder_bytes, const Place& place);

/// Throws Error (input): an image that libraries cannot decode, with the message of the library.
[[noreturn]] void refuse_damaged(const Place& place, const std::string& message);

/// Two or four bytes of a number, the more significant first.
inline std::uint32_t big_endian(std::string_view bytes, std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8U | static_cast<std::uint8_t>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
}

// ---- headers of single formats; width and height unchecked ----

Header png_header(std::string_view bytes, const Place& place);
Header jpeg_header(std::string_view bytes, const Place& place);
Header webp_header(std::string_view bytes, const Place& place);
Header gif_header(std::string_view bytes, const Place& place);

}  // namespace ostraka::images
