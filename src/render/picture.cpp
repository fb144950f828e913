#include "ostraka/render/picture.h"

#include "ostraka/core/error.h"

#include <cairo.h>

#include <cstring>
#include <memory>

namespace ostraka {

namespace {
using CairoSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
    try {
        static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    } catch (const std::bad_alloc&) {
        return CAIRO_STATUS_NO_MEMORY;
    }
    return CAIRO_STATUS_SUCCESS;
}

struct Reader {
    const std::string& bytes;
    std::size_t position = 0;
};

cairo_status_t take(void* reader, unsigned char* data, unsigned int length) {
    auto& from = *static_cast<Reader*>(reader);
    if (from.bytes.size() - from.position < length) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, from.bytes.data() + from.position, length);
    from.position += length;
    return CAIRO_STATUS_SUCCESS;
}

int hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}
}  // namespace

Rgb parse_colour(const std::string& text) {
    if (text == "white") return {255, 255, 255};
    if (text == "black") return {0, 0, 0};
    if (text == "grey") return {128, 128, 128};
    bool good = text.size() == 7 && text[0] == '#';
    for (std::size_t i = 1; good && i < 7; ++i) good = hexadecimal(text[i]) >= 0;
    if (!good) fail_usage("'" + text + "' is not a colour", "use #rrggbb, white, black or grey");
    const auto channel = [&](std::size_t i) {
        return static_cast<std::uint8_t>(hexadecimal(text[i]) * 16 + hexadecimal(text[i + 1]));
    };
    return {channel(1), channel(3), channel(5)};
}

void write_png(const Path& file, const Picture& picture) {
    const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, picture.width, picture.height),
                               &cairo_surface_destroy);
    const auto failed = [](cairo_status_t status) {
        throw Error(ErrorKind::failure, "picture", cairo_status_to_string(status), "use a smaller size");
    };
    if (const auto status = cairo_surface_status(surface.get()); status != CAIRO_STATUS_SUCCESS) failed(status);
    unsigned char* rows = cairo_image_surface_get_data(surface.get());
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
    const auto width = static_cast<std::size_t>(picture.width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(picture.height); ++row)
        std::memcpy(rows + row * stride, picture.argb.data() + row * width, width * sizeof(std::uint32_t));
    cairo_surface_mark_dirty(surface.get());
    std::string bytes;
    if (const auto status = cairo_surface_write_to_png_stream(surface.get(), &append, &bytes); status != CAIRO_STATUS_SUCCESS)
        failed(status);
    write_file(file, bytes);
}

Picture read_png(const Path& file) {
    const std::string bytes = read_file(file);
    Reader reader{bytes};
    const CairoSurface surface(cairo_image_surface_create_from_png_stream(&take, &reader), &cairo_surface_destroy);
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

}  // namespace ostraka
