#include "ostraka/image/image.h"

#include "image/codecs.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace images {

Pixels blank_pixels(int width, int height) {
    Pixels pixels{width, height, {}};
    pixels.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return pixels;
}

bool is_translucent(const Pixels& pixels) {
    return std::any_of(pixels.rgba.begin(), pixels.rgba.end(), [](const auto& pixel) { return pixel[3] < 255; });
}

}  // namespace images

std::string media_type(ImageFormat format) {
    static constexpr const char* types[] = {"image/png", "image/jpeg", "image/webp", "image/gif"};
    return enum_name(format, types);
}

std::string extension_of(ImageFormat format) {
    static constexpr const char* endings[] = {".png", ".jpg", ".webp", ".gif"};
    return enum_name(format, endings);
}

Image parse_image(std::string bytes, const std::string& name, const std::string& where) {
    const images::Header header = images::read_header(bytes, images::place_of(name, where));
    return {name, std::move(bytes), header.format, header.width, header.height};
}

Image read_image(const Path& file) { return parse_image(read_file(file), file.filename().string(), file.string()); }

Pixels decode(const Image& image, const std::string& where) {
    const images::Place place = images::place_of(image.name, where);
    const images::Header header = images::read_header(image.bytes, place);
    switch (header.format) {
        case ImageFormat::png:
            return images::decode_png(image.bytes, header, place);
        case ImageFormat::jpeg:
            return images::decode_jpeg(image.bytes, header, place);
        case ImageFormat::webp:
            return images::decode_webp(image.bytes, header, place);
        default:
            return images::decode_gif(image.bytes, header, place);
    }
}

Image encode(const Pixels& pixels, ImageFormat format, const std::string& name, int quality) {
    const auto width = static_cast<std::size_t>(std::max(pixels.width, 0));
    const auto height = static_cast<std::size_t>(std::max(pixels.height, 0));
    if (width == 0 || height == 0 || pixels.rgba.size() != width * height)
        fail_usage(fmt::format("{} pixels are no image of {} x {}", pixels.rgba.size(), pixels.width, pixels.height));
    // Largest sides of each format, in the order of the enumerators; WebP has 14 bits for a side.
    static constexpr int max_sides[] = {max_image_side, max_image_side, 16383, 0};
    const int max_side = max_sides[static_cast<std::size_t>(format)];
    if (format == ImageFormat::gif) fail_usage("GIF images are not written", "write PNG, JPEG or WebP");
    if (std::max(pixels.width, pixels.height) > max_side)
        fail_usage(fmt::format("{} x {} pixels are too many for {}; the limit is {} in each direction", pixels.width,
                               pixels.height, media_type(format), max_side));
    if (quality < 1 || quality > 100) fail_usage(fmt::format("the quality of an image is {}", quality), "give 1 to 100");
    Image image{name, {}, format, pixels.width, pixels.height};
    if (format == ImageFormat::png) image.bytes = images::encode_png(pixels);
    else if (format == ImageFormat::jpeg) image.bytes = images::encode_jpeg(pixels, quality);
    else image.bytes = images::encode_webp(pixels, quality);
    return image;
}

}  // namespace ostraka
