#include "ostraka/render/picture.h"

#include "ostraka/core/error.h"

#include <cairo.h>

#include <charconv>
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

}  // namespace

Rgb parse_colour(const std::string& text) {
    if (text == "white") return {255, 255, 255};
    if (text == "black") return {0, 0, 0};
    if (text == "grey") return {128, 128, 128};
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    if (text.size() != 7 || text[0] != '#' || std::from_chars(text.data() + 1, end, value, 16).ptr != end)
        fail_usage("'" + text + "' is not a colour", "use #rrggbb, white, black or grey");
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>(value >> shift & 0xFFU); };
    return {channel(16), channel(8), channel(0)};
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

}  // namespace ostraka
