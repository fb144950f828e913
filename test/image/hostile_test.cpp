// Cut and mutated images: an error of kind input, or pixels of the claimed size; nothing else.
#include "mutate.h"
#include "samples.h"

#include "ostraka/core/error.h"
#include "ostraka/image/image.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

Rgba textured(int column, int row) {
    return {static_cast<std::uint8_t>(7 * column + row), static_cast<std::uint8_t>(5 * row),
            static_cast<std::uint8_t>(column * row), static_cast<std::uint8_t>(255 - row)};
}

std::vector<std::pair<std::string, std::string>> small_images() {
    const Pixels pixels = test::painted(32, 24, textured);
    test::GifSample gif;
    for (int i = 0; i < 64; ++i) gif.indices.push_back(static_cast<std::uint8_t>(i));
    test::PngSample interlaced;
    interlaced.interlaced = true;
    interlaced.depth = 16;
    interlaced.colour_type = PNG_COLOR_TYPE_GRAY_ALPHA;
    for (int row = 0; row < 8; ++row) interlaced.rows.emplace_back(32, static_cast<char>(17 * row));
    return {{"png", encode(pixels, ImageFormat::png, {}).bytes},
            {"interlaced png", test::png_bytes(interlaced)},
            {"jpeg", encode(pixels, ImageFormat::jpeg, {}).bytes},
            {"progressive jpeg", test::jpeg_bytes({.progressive = true, .restart = 1}, textured)},
            {"inks jpeg", test::jpeg_bytes({.channels = 4, .ycck = true}, textured)},
            {"webp", encode(pixels, ImageFormat::webp, {}).bytes},
            {"lossless webp", encode(pixels, ImageFormat::webp, {}, 100).bytes},
            {"gif", test::gif_bytes(gif)}};
}

/// True if the bytes give pixels.
bool is_decoded(const std::string& bytes, Pixels* result = nullptr) {
    try {
        const Image image = parse_image(bytes, "image", "test");
        const Pixels pixels = decode(image, "test");
        EXPECT_EQ(pixels.width, image.width);
        EXPECT_EQ(pixels.height, image.height);
        EXPECT_EQ(pixels.rgba.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
        if (result != nullptr) *result = pixels;
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        return false;
    }
}

TEST(HostileImage, CutAtEveryByte) {
    for (const auto& [name, bytes] : small_images()) {
        Pixels whole;
        ASSERT_TRUE(is_decoded(bytes, &whole)) << name;
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            Pixels pixels;
            // Only what follows the pixels (the end marker, a checksum) may be missing.
            if (is_decoded(bytes.substr(0, size), &pixels)) {
                EXPECT_EQ(pixels.rgba, whole.rgba) << name << " cut to " << size << " of " << bytes.size();
                EXPECT_GE(size + 24, bytes.size()) << name;
            }
        }
    }
}

TEST(HostileImage, Mutated) {
    for (const auto& [name, bytes] : small_images()) {
        SCOPED_TRACE(name);
        std::size_t decoded = 0;
        for (std::uint64_t seed = 0; seed < 1500; ++seed) decoded += is_decoded(test::mutate(bytes, seed)) ? 1 : 0;
        EXPECT_LT(decoded, 1500U);
    }
}

TEST(HostileImage, EveryByteReplaced) {
    for (const auto& [name, bytes] : small_images())
        for (std::size_t at = 0; at < bytes.size(); ++at)
            for (const char value : {'\0', '\x7f', '\xff'}) {
                std::string damaged = bytes;
                damaged[at] = value;
                is_decoded(damaged);
            }
}

}  // namespace
}  // namespace ostraka
