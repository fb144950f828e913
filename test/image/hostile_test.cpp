// Cut and mutated images: an error of kind input, or pixels of the claimed size; nothing else.
#include "mutate.h"
#include "samples.h"

#include "ostraka/core/error.h"
#include "ostraka/image/image.h"

#include <gtest/gtest.h>
#include <zlib.h>

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

/// The PNG with the checksums of its chunks made right, so that damage reaches the decoder.
std::string with_checksums(std::string bytes) {
    const auto byte = [&](std::size_t at) { return std::size_t{static_cast<std::uint8_t>(bytes[at])}; };
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t length = byte(at) << 24U | byte(at + 1) << 16U | byte(at + 2) << 8U | byte(at + 3);
        if (length > bytes.size() - at - 12) break;
        const auto* chunk = reinterpret_cast<const Bytef*>(bytes.data() + at + 4);
        const auto checksum = ::crc32(0, chunk, static_cast<uInt>(length + 4));
        for (std::size_t k = 0; k < 4; ++k) bytes[at + 8 + length + k] = static_cast<char>(checksum >> (24 - 8 * k) & 255U);
        at += 12 + length;
    }
    return bytes;
}

TEST(HostileImage, MutatedPngWithRightChecksums) {
    std::size_t decoded = 0;
    for (const auto& [name, bytes] : small_images())
        if (name.ends_with("png"))
            for (std::uint64_t seed = 0; seed < 1500; ++seed)
                decoded += is_decoded(with_checksums(test::mutate(bytes, seed))) ? 1 : 0;
    EXPECT_GT(decoded, 0U);
}

TEST(HostileImage, JpegOfOtherSizes) {
    for (const auto& [name, bytes] : small_images()) {
        if (!name.ends_with("jpeg")) continue;
        const std::size_t frame = std::min(bytes.find("\xff\xc0"), bytes.find("\xff\xc2"));
        for (int width = 1; width < 65536; width = width * 3 + 1)
            for (int height = 1; height < 65536; height = height * 2 + 1) {
                std::string damaged = bytes;
                for (const auto& [at, side] : {std::pair(frame + 5, height), std::pair(frame + 7, width)}) {
                    damaged[at] = static_cast<char>(side >> 8);
                    damaged[at + 1] = static_cast<char>(side & 255);
                }
                // 32 x 24 pixels are 36 blocks at most; a file cannot have many more.
                EXPECT_FALSE(is_decoded(damaged) && width > 2000 && height > 2000) << name;
            }
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
