// WebP (RFC 9649) with libwebp.
#include "image/codecs.h"

#include <fmt/core.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include <cmath>
#include <memory>

namespace ostraka::images {

namespace {

const std::uint8_t* webp_bytes(std::string_view bytes) { return reinterpret_cast<const std::uint8_t*>(bytes.data()); }

const char* status_text(VP8StatusCode status) {
    switch (status) {
        case VP8_STATUS_OUT_OF_MEMORY:
            return "there is no memory for its pixels";
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return "it uses a feature that libwebp does not know";
        case VP8_STATUS_SUSPENDED:
        case VP8_STATUS_NOT_ENOUGH_DATA:
            return "the file ends before its pixels do";
        default:
            return "its data are not those of a WebP";
    }
}

WebPBitstreamFeatures features_of(std::string_view bytes, const Place& place) {
    WebPBitstreamFeatures features{};
    const auto status = WebPGetFeatures(webp_bytes(bytes), bytes.size(), &features);
    if (status != VP8_STATUS_OK) refuse_damaged(place, status_text(status));
    return features;
}

}  // namespace

Header webp_header(std::string_view bytes, const Place& place) {
    const WebPBitstreamFeatures features = features_of(bytes, place);
    if (features.has_animation != 0)
        refuse(place, "is an animated WebP, which is not read", "save one of its pictures as PNG, for example with webpmux");
    return {ImageFormat::webp, features.width, features.height};
}

Pixels decode_webp(std::string_view bytes, const Header& header, const Place& place) {
    WebPDecoderConfig config;
    if (WebPInitDecoderConfig(&config) == 0) fail_work("", "another version of libwebp is installed than Ostraka was built for");
    config.input = features_of(bytes, place);
    // Lossless images are decoded as a whole (4 bytes a pixel); of lossy ones the alpha channel.
    constexpr int lossy = 1;
    const double decoder_bytes = config.input.format == lossy ? 1 : 4;
    // The modes of each macroblock of 16 x 16 pixels take more than a bit (RFC 6386, section 11: their probabilities are fixed).
    const double macroblocks = std::ceil(header.width / 16.0) * std::ceil(header.height / 16.0);
    if (config.input.format == lossy && macroblocks > 8 * static_cast<double>(bytes.size()))
        refuse_damaged(place, fmt::format("the file is too small for {} x {} pixels", header.width, header.height));
    require_proportion(header, bytes.size(), decoder_bytes * header.width * header.height, place);
    Pixels pixels = blank_pixels(header.width, header.height);
    config.output.colorspace = MODE_RGBA;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = pixels.rgba.front().data();
    config.output.u.RGBA.stride = 4 * header.width;
    config.output.u.RGBA.size = 4 * pixels.rgba.size();
    const auto status = WebPDecode(webp_bytes(bytes), bytes.size(), &config);
    WebPFreeDecBuffer(&config.output);
    if (status == VP8_STATUS_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != VP8_STATUS_OK) refuse_damaged(place, status_text(status));
    return pixels;
}

std::string encode_webp(const Pixels& pixels, int quality) {
    WebPConfig config;
    WebPPicture picture;
    if (WebPConfigInit(&config) == 0 || WebPPictureInit(&picture) == 0)
        fail_work("", "another version of libwebp is installed than Ostraka was built for");
    config.lossless = quality == 100 ? 1 : 0;
    config.exact = 1;  // keeps the colours of transparent pixels
    config.quality = config.lossless != 0 ? 75.0F : static_cast<float>(quality);
    picture.use_argb = 1;
    picture.width = pixels.width;
    picture.height = pixels.height;
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
    const bool done =
        WebPPictureImportRGBA(&picture, pixels.rgba.front().data(), 4 * pixels.width) != 0 && WebPEncode(&config, &picture) != 0;
    const int code = picture.error_code;
    WebPPictureFree(&picture);
    const std::unique_ptr<WebPMemoryWriter, decltype(&WebPMemoryWriterClear)> clear(&writer, &WebPMemoryWriterClear);
    if (!done) fail_work("", fmt::format("an image could not be written as WebP (error {} of libwebp)", code));
    return {reinterpret_cast<const char*>(writer.mem), writer.size};
}

}  // namespace ostraka::images
