#include "ostraka/render/picture.h"

#include "ostraka/core/error.h"
#include "render/canvas.h"

#include <cairo.h>
#include <fmt/core.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>

namespace ostraka {

namespace {
using CairoSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

/// Inserts the resolution after the header of a PNG file: the chunk pHYs, with whole pixels per metre.
void add_resolution(std::string& png, double pixels_per_metre) {
    const double rounded = std::round(pixels_per_metre);
    if (!(rounded >= 1 && rounded <= 2147483647)) return;
    const auto big_endian = [](std::uint32_t value) {
        std::string bytes;
        for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> static_cast<unsigned>(shift) & 255U);
        return bytes;
    };
    const std::string pixels = big_endian(static_cast<std::uint32_t>(rounded));
    const std::string body = "pHYs" + pixels + pixels + '\1';  // 1: the unit is the metre
    const auto checksum = ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    constexpr std::size_t after_header = 8 + 25;  // the signature and the chunk IHDR
    png.insert(after_header, big_endian(9) + body + big_endian(static_cast<std::uint32_t>(checksum)));
}

}  // namespace

std::string stable_svg(const std::string& svg) {
    static constexpr std::string_view kinds[] = {"surface", "image", "mask", "clip", "linear", "radial", "pattern", "source"};
    std::map<std::string, std::string> names;
    std::string result;
    result.reserve(svg.size());
    for (std::size_t i = 0; i < svg.size();) {
        const char previous = i > 0 ? svg[i - 1] : ' ';
        if (previous == '"' || previous == '#') {
            const std::string_view remainder = std::string_view(svg).substr(i, 24);
            const auto* kind =
                std::find_if(std::begin(kinds), std::end(kinds), [&](std::string_view k) { return remainder.starts_with(k); });
            if (kind != std::end(kinds)) {
                std::size_t end = kind->size();
                while (end < remainder.size() && remainder[end] >= '0' && remainder[end] <= '9') ++end;
                if (end > kind->size()) {
                    const auto [name, inserted] = names.try_emplace(std::string(remainder.substr(0, end)));
                    if (inserted) name->second = std::string(*kind) + std::to_string(names.size());
                    result += name->second;
                    i += end;
                    continue;
                }
            }
        }
        result += svg[i++];
    }
    return result;
}

PictureKind picture_kind(const std::string& file) {
    const std::string kind = extension(file);
    if (kind == ".png") return PictureKind::pixels;
    if (kind == ".svg") return PictureKind::svg;
    if (kind == ".pdf") return PictureKind::pdf;
    fail_usage(fmt::format("the picture '{}' does not end in .png, .svg or .pdf", file), "give the picture as the last argument");
}

Rgb parse_colour(const std::string& text) {
    if (text == "white") return {255, 255, 255};
    if (text == "black") return {0, 0, 0};
    if (text == "grey") return {128, 128, 128};
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    if (text.size() != 7 || text[0] != '#' || std::from_chars(text.data() + 1, end, value, 16).ptr != end)
        fail_usage(fmt::format("'{}' is not a colour", text), "use #rrggbb, white, black or grey");
    const auto channel = [&](int shift) { return static_cast<std::uint8_t>(value >> shift & 0xFFU); };
    return {channel(16), channel(8), channel(0)};
}

void write_png(const Path& file, const Picture& picture, double pixels_per_metre) {
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
    if (const auto status = cairo_surface_write_to_png_stream(surface.get(), &detail::append_bytes, &bytes);
        status != CAIRO_STATUS_SUCCESS)
        failed(status);
    add_resolution(bytes, pixels_per_metre);
    write_file(file, bytes);
}

void write_png(const Path& file, const DeepPicture& picture, double pixels_per_metre) {
    std::string bytes;
    std::string message;
    const auto failed = [](png_structp png, png_const_charp text) {
        *static_cast<std::string*>(png_get_error_ptr(png)) = text;
        png_longjmp(png, 1);
    };
    const auto ignore = [](png_structp, png_const_charp) {};
    const auto write = [](png_structp png, png_bytep data, png_size_t length) {
        auto* output = static_cast<std::string*>(png_get_io_ptr(png));
        if (output->capacity() - output->size() < length) png_error(png, "memory runs out");
        output->append(reinterpret_cast<const char*>(data), length);
    };
    const auto flush = [](png_structp) {};
    // The format stores the more significant byte first.
    const auto width = static_cast<std::size_t>(picture.width), height = static_cast<std::size_t>(picture.height);
    std::vector<png_byte> data(width * height * 8);
    for (std::size_t i = 0; i < width * height; ++i)
        for (std::size_t k = 0; k < 4; ++k) {
            data[8 * i + 2 * k] = static_cast<png_byte>(picture.rgba[i][k] >> 8U);
            data[8 * i + 2 * k + 1] = static_cast<png_byte>(picture.rgba[i][k] & 255U);
        }
    std::vector<png_bytep> rows;
    for (std::size_t row = 0; row < height; ++row) rows.push_back(data.data() + row * width * 8);
    bytes.reserve(data.size() + data.size() / 64 + 4096);  // reserved, because no exception may pass through the library
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, failed, ignore);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr) throw std::bad_alloc();
    if (setjmp(png_jmpbuf(png)) == 0) {
        png_set_write_fn(png, &bytes, write, flush);
        png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 16,
                     PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_rows(png, info, rows.data());
        png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    }
    png_destroy_write_struct(&png, &info);
    if (!message.empty()) throw Error(ErrorKind::failure, "picture", message, "use a smaller size");
    add_resolution(bytes, pixels_per_metre);
    write_file(file, bytes);
}

}  // namespace ostraka
