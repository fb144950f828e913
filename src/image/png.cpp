// PNG (W3C, Portable Network Graphics, third edition) with libpng. Errors of libpng leave its functions by longjmp: the functions
// that call libpng run in `guarded`, and have no objects with destructors.
#include "image/codecs.h"

#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

namespace ostraka::images {

namespace {

struct PngReader {
    PngReader() = default;
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string_view bytes;
    std::size_t position = 0;
    std::jmp_buf failed{};
    std::array<char, 200> message{};  ///< of the error
};

/// Runs a step; false if libpng reported an error.
template <class Step>
bool guarded(PngReader& reader, const Step& step) {
    if (setjmp(reader.failed) != 0) return false;
    step();
    return true;
}

void png_failed(png_structp png, png_const_charp message) {
    auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader.message.data(), message, reader.message.size() - 1);
    std::longjmp(reader.failed, 1);
}

void png_warning_ignored(png_structp /*png*/, png_const_charp /*message*/) {}

void png_take(png_structp png, png_bytep target, png_size_t length) {
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (reader.bytes.size() - reader.position < length) png_error(png, "the file ends before its pixels do");
    std::memcpy(target, reader.bytes.data() + reader.position, length);
    reader.position += length;
}

/// Everything that does not change pixels is skipped: colour profiles, texts, gamma.
void skip_ancillary_chunks(png_structp png) {
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_chunk_cache_max(png, 100);
    png_set_chunk_malloc_max(png, 4000000);
}

/// Reads the header and sets the conversion to 8 bits of red, green, blue and alpha.
void start_png(PngReader& reader) {
    png_structp png = reader.png;
    png_set_read_fn(png, &reader, png_take);
    png_set_user_limits(png, max_image_side, max_image_side);
    png_set_benign_errors(png, 1);
    skip_ancillary_chunks(png);
    png_read_info(png, reader.info);
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, reader.info);
}

/// Deflate compresses by a factor of at most 1032: a smaller file cannot have all pixels.
void require_png_data(std::string_view bytes, const Header& header, const Place& place) {
    static constexpr int channels[] = {1, 0, 3, 1, 2, 0, 4};  // by colour type
    const auto kind = static_cast<std::uint8_t>(bytes[25]);
    const double bits = static_cast<std::uint8_t>(bytes[24]) * (kind < 7 ? channels[kind] : 0);
    if (bits * header.width / 8 * header.height > 1032.0 * static_cast<double>(bytes.size()))
        refuse_damaged(place, fmt::format("the file is too small for {} x {} pixels", header.width, header.height));
}

}  // namespace

Pixels decode_png(std::string_view bytes, const Header& header, const Place& place) {
    require_png_data(bytes, header, place);
    require_proportion(header, bytes.size(), 0, place);
    PngReader reader;
    reader.bytes = bytes;
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, png_failed, png_warning_ignored);
    if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
    if (reader.info == nullptr) throw std::bad_alloc();
    if (!guarded(reader, [&reader] { start_png(reader); })) refuse_damaged(place, reader.message.data());
    const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
    if (png_get_image_width(reader.png, reader.info) != width || png_get_image_height(reader.png, reader.info) != height ||
        png_get_rowbytes(reader.png, reader.info) != 4 * width)
        refuse_damaged(place, "its rows do not have the length that its header claims");
    Pixels pixels = blank_pixels(header.width, header.height);
    std::vector<png_bytep> rows(height);
    for (std::size_t row = 0; row < height; ++row) rows[row] = pixels.rgba[row * width].data();
    // The end of the file behind the pixels is not read: texts and times do not matter.
    if (!guarded(reader, [&] { png_read_image(reader.png, rows.data()); })) refuse_damaged(place, reader.message.data());
    return pixels;
}

std::string encode_png(const Pixels& pixels) {
    const bool translucent = is_translucent(pixels);
    std::vector<std::array<std::uint8_t, 3>> rgb;
    if (!translucent) {
        rgb.reserve(pixels.rgba.size());
        for (const auto& pixel : pixels.rgba) rgb.push_back({pixel[0], pixel[1], pixel[2]});
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(pixels.width);
    image.height = static_cast<png_uint_32>(pixels.height);
    image.format = translucent ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    const void* source = translucent ? static_cast<const void*>(pixels.rgba.data()) : rgb.data();
    const int done = png_image_write_to_memory(&image, bytes.data(), &size, 0, source, 0, nullptr);
    const std::string message = image.message;
    png_image_free(&image);
    if (done == 0) fail_work("", fmt::format("an image could not be written as PNG: {}", message));
    bytes.resize(size);
    bytes.shrink_to_fit();
    return bytes;
}

}  // namespace ostraka::images
