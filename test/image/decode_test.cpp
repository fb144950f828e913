// Decoding of all kinds of PNG, JPEG, WebP and GIF, against pixels that are known exactly.
#include "samples.h"

#include "ostraka/core/error.h"
#include "ostraka/image/image.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using test::painted;
using Rgba = std::array<std::uint8_t, 4>;

Pixels decoded(const std::string& bytes) { return decode(parse_image(bytes, "sample", "test"), "test"); }

std::uint8_t shade(int column, int row) { return static_cast<std::uint8_t>(16 * column + row); }

/// 16-bit samples whose nearest 8-bit values are known: 257 c + remainder, below half a step.
int deep_sample(int column, int row) { return 257 * shade(column, row) + (shade(column, row) < 255 ? 120 : 0); }

std::string png_of(int depth, int type, bool interlaced, const std::function<std::vector<int>(int, int)>& samples) {
    test::PngSample sample;
    sample.depth = depth;
    sample.colour_type = type;
    sample.interlaced = interlaced;
    for (int row = 0; row < 8; ++row) {
        std::string line;
        for (int column = 0; column < 8; ++column)
            for (const int value : samples(column, row)) {
                if (depth == 16) line += static_cast<char>(value >> 8);
                line += static_cast<char>(value & 255);
            }
        sample.rows.push_back(line);
    }
    return test::png_bytes(sample);
}

TEST(DecodePng, AllChannelsAndDepths) {
    for (const bool interlaced : {false, true}) {
        const auto grey = painted(8, 8, [](int i, int j) { return Rgba{shade(i, j), shade(i, j), shade(i, j), 255}; });
        EXPECT_EQ(
            decoded(png_of(8, PNG_COLOR_TYPE_GRAY, interlaced, [](int i, int j) { return std::vector<int>{shade(i, j)}; })).rgba,
            grey.rgba);
        EXPECT_EQ(
            decoded(png_of(16, PNG_COLOR_TYPE_GRAY, interlaced, [](int i, int j) { return std::vector<int>{deep_sample(i, j)}; }))
                .rgba,
            grey.rgba);
        const auto grey_alpha = painted(8, 8, [](int i, int j) {
            return Rgba{shade(i, j), shade(i, j), shade(i, j), shade(j, i)};
        });
        EXPECT_EQ(decoded(png_of(8, PNG_COLOR_TYPE_GRAY_ALPHA, interlaced,
                                 [](int i, int j) {
                                     return std::vector<int>{shade(i, j), shade(j, i)};
                                 }))
                      .rgba,
                  grey_alpha.rgba);
        const auto rgb = painted(8, 8, [](int i, int j) { return Rgba{shade(i, j), shade(j, i), 7, 255}; });
        EXPECT_EQ(decoded(png_of(8, PNG_COLOR_TYPE_RGB, interlaced,
                                 [](int i, int j) {
                                     return std::vector<int>{shade(i, j), shade(j, i), 7};
                                 }))
                      .rgba,
                  rgb.rgba);
        const auto rgba = painted(8, 8, [](int i, int j) { return Rgba{shade(i, j), shade(j, i), 7, shade(7 - i, j)}; });
        EXPECT_EQ(
            decoded(png_of(16, PNG_COLOR_TYPE_RGB_ALPHA, interlaced,
                           [](int i, int j) {
                               return std::vector<int>{deep_sample(i, j), deep_sample(j, i), 7 * 257, deep_sample(7 - i, j)};
                           }))
                .rgba,
            rgba.rgba);
    }
}

TEST(DecodePng, FewBitsPalettesAndTransparentColours) {
    test::PngSample bits;
    bits.depth = 1;
    bits.colour_type = PNG_COLOR_TYPE_GRAY;
    for (int row = 0; row < 8; ++row) bits.rows.emplace_back(1, static_cast<char>(row % 2 == 0 ? 0xAA : 0x55));
    EXPECT_EQ(decoded(test::png_bytes(bits)).rgba, painted(8, 8, [](int i, int j) {
                                                       const std::uint8_t value = (i + j) % 2 == 0 ? 255 : 0;
                                                       return Rgba{value, value, value, 255};
                                                   }).rgba);
    test::PngSample palette;
    palette.depth = 2;
    palette.colour_type = PNG_COLOR_TYPE_PALETTE;
    palette.palette = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}, {100, 110, 120}};
    palette.palette_alpha = {0, 128};
    for (int row = 0; row < 8; ++row) palette.rows.emplace_back("\x1B\x1B");  // 0 1 2 3 0 1 2 3
    EXPECT_EQ(decoded(test::png_bytes(palette)).rgba, painted(8, 8, [](int i, int) {
                                                          const int k = i % 4;
                                                          return Rgba{static_cast<std::uint8_t>(10 + 30 * k),
                                                                      static_cast<std::uint8_t>(20 + 30 * k),
                                                                      static_cast<std::uint8_t>(30 + 30 * k),
                                                                      static_cast<std::uint8_t>(k == 0   ? 0
                                                                                                : k == 1 ? 128
                                                                                                         : 255)};
                                                      }).rgba);
    test::PngSample keyed;
    keyed.colour_type = PNG_COLOR_TYPE_RGB;
    png_color_16 key{};
    key.red = 3;
    key.green = 1;
    key.blue = 2;
    keyed.transparent = key;
    for (int row = 0; row < 8; ++row) {
        std::string line;
        for (int column = 0; column < 8; ++column) line += {static_cast<char>(column), 1, 2};
        keyed.rows.push_back(line);
    }
    EXPECT_EQ(decoded(test::png_bytes(keyed)).rgba,
              painted(8, 8, [](int i, int) {
                  return Rgba{static_cast<std::uint8_t>(i), 1, 2, static_cast<std::uint8_t>(i == 3 ? 0 : 255)};
              }).rgba);
}

Rgba smooth(int column, int row) {
    return {static_cast<std::uint8_t>(4 * column + 40), static_cast<std::uint8_t>(6 * row + 30), 120,
            static_cast<std::uint8_t>(255 - 3 * row)};
}

TEST(DecodeJpeg, ColoursGreyAndProgressive) {
    const auto colours = painted(32, 24, [](int i, int j) { return Rgba{smooth(i, j)[0], smooth(i, j)[1], 120, 255}; });
    const auto grey = painted(32, 24, [](int i, int j) { return Rgba{smooth(i, j)[0], smooth(i, j)[0], smooth(i, j)[0], 255}; });
    for (const bool progressive : {false, true})
        for (const int restart : {0, 2}) {
            EXPECT_LE(test::largest_difference(
                          decoded(test::jpeg_bytes({.progressive = progressive, .restart = restart}, smooth)), colours),
                      6);
            EXPECT_LE(
                test::largest_difference(
                    decoded(test::jpeg_bytes({.channels = 1, .progressive = progressive, .restart = restart}, smooth)), grey),
                3);
        }
}

TEST(DecodeJpeg, InksOfAdobeAreInverted) {
    // Inks as stored by Adobe's programs: 255 is no ink.
    const auto expected = painted(32, 24, [](int i, int j) {
        const Rgba inks = smooth(i, j);
        const auto light = [&](std::size_t k) { return static_cast<std::uint8_t>((inks[k] * inks[3] + 127) / 255); };
        return Rgba{light(0), light(1), light(2), 255};
    });
    EXPECT_LE(test::largest_difference(decoded(test::jpeg_bytes({.channels = 4}, smooth)), expected), 4);
    EXPECT_LE(test::largest_difference(decoded(test::jpeg_bytes({.channels = 4, .ycck = true}, smooth)), expected), 6);
    const auto inverted = [](int i, int j) {
        Rgba inks = smooth(i, j);
        for (auto& ink : inks) ink = static_cast<std::uint8_t>(255 - ink);
        return inks;
    };
    EXPECT_LE(test::largest_difference(decoded(test::jpeg_bytes({.channels = 4, .adobe = false}, inverted)), expected), 4);
}

TEST(DecodeJpeg, ManyScansAreRefused) {
    const std::string few = test::jpeg_bytes({.progressive = true, .repeated_scans = 60}, smooth);
    EXPECT_EQ(decoded(few).width, 32);
    try {
        decoded(test::jpeg_bytes({.progressive = true, .repeated_scans = 180}, smooth));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(error.problem().find("more than 100 scans"), std::string::npos) << error.what();
    }
}

TEST(DecodeJpeg, AFileWithoutItsEndMarkerIsRead) {
    const std::string bytes = test::jpeg_bytes({}, smooth);
    EXPECT_EQ(decoded(bytes.substr(0, bytes.size() - 2)).rgba, decoded(bytes).rgba);
    const std::string progressive = test::jpeg_bytes({.progressive = true}, smooth);
    EXPECT_THROW(decoded(progressive.substr(0, progressive.size() - 2)), Error);
}

TEST(DecodeGif, FirstPicture) {
    const auto index = [](int i, int j) { return static_cast<std::uint8_t>((5 * i + 9 * j) % 64); };
    test::GifSample sample;
    sample.screen_width = 11;
    sample.screen_height = 9;
    sample.left = 2;
    sample.top = 1;
    sample.transparent = 14;
    const auto expected = painted(11, 9, [&](int i, int j) {
        if (i < 2 || i >= 10 || j < 1 || index(i - 2, j - 1) == 14) return Rgba{0, 0, 0, 0};
        return test::gif_colour(index(i - 2, j - 1));
    });
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i) sample.indices.push_back(index(i, j));
    EXPECT_EQ(decoded(test::gif_bytes(sample)).rgba, expected.rgba);
    // Interlaced: rows 0, 4, 2, 6, 1, 3, 5, 7.
    sample.indices.clear();
    sample.interlaced = true;
    for (const int j : {0, 4, 2, 6, 1, 3, 5, 7})
        for (int i = 0; i < 8; ++i) sample.indices.push_back(index(i, j));
    EXPECT_EQ(decoded(test::gif_bytes(sample)).rgba, expected.rgba);
    sample.left = 4;
    EXPECT_THROW(decoded(test::gif_bytes(sample)), Error);
}

TEST(DecodeWebp, LosslessIsExactAndLossyIsNear) {
    const Pixels pixels = painted(31, 17, [](int i, int j) {
        return Rgba{shade(i % 16, j), 9, shade(j, i % 16), shade(i % 15, j)};
    });
    const Image lossless = encode(pixels, ImageFormat::webp, "a.webp", 100);
    EXPECT_EQ(lossless.format, ImageFormat::webp);
    EXPECT_EQ(decode(lossless, "test").rgba, pixels.rgba);
    const Pixels smooth_pixels = test::gradient(32, 32);
    EXPECT_LE(test::largest_difference(decode(encode(smooth_pixels, ImageFormat::webp, "a.webp", 90), "test"), smooth_pixels),
              16);
}

}  // namespace
}  // namespace ostraka
