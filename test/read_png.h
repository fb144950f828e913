// Reads pictures back.
#pragma once

#include "ostraka/core/error.h"
#include "ostraka/render/picture.h"

#include <cairo.h>

#include <cstring>
#include <memory>

namespace ostraka::test {

struct PngReader {
    const std::string& bytes;
    std::size_t position = 0;
};

inline cairo_status_t take_bytes(void* reader, unsigned char* data, unsigned int length) {
    auto& from = *static_cast<PngReader*>(reader);
    if (from.bytes.size() - from.position < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, from.bytes.data() + from.position, length);
    from.position += length;
    return CAIRO_STATUS_SUCCESS;
}

/// Throws Error (input) if the file is not a PNG.
inline Picture read_png(const Path& file) {
    const std::string bytes = read_file(file);
    PngReader reader{bytes};
    const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
        cairo_image_surface_create_from_png_stream(&take_bytes, &reader), &cairo_surface_destroy);
    if (const auto status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS)
        fail_input(file.string(), std::string("is not a PNG file: ") + cairo_status_to_string(status));
    const bool opaque = cairo_image_surface_get_format(surface.get()) == CAIRO_FORMAT_RGB24;
    if (!opaque && cairo_image_surface_get_format(surface.get()) != CAIRO_FORMAT_ARGB32)
        fail_input(file.string(), "has an unusual depth", "save it with 8 bits a channel");
    Picture picture;
    picture.width = cairo_image_surface_get_width(surface.get());
    picture.height = cairo_image_surface_get_height(surface.get());
    const auto width = static_cast<std::size_t>(picture.width);
    picture.argb.resize(width * static_cast<std::size_t>(picture.height));
    const unsigned char* rows = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    for (std::size_t row = 0; row < static_cast<std::size_t>(picture.height); ++row)
        std::memcpy(picture.argb.data() + row * width, rows + row * stride, width * sizeof(std::uint32_t));
    if (opaque)
        for (auto& pixel : picture.argb) pixel |= 0xFF000000U;
    return picture;
}

}  // namespace ostraka::test
