#include "samples.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/image/appearance.h"
#include "ostraka/image/image.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::painted;
using Rgba = std::array<std::uint8_t, 4>;

TEST(Srgb, RoundTripAndNearestChannel) {
    EXPECT_EQ(linear_from_srgb(0), 0.0F);
    EXPECT_EQ(linear_from_srgb(255), 1.0F);
    EXPECT_NEAR(linear_from_srgb(188), 0.5029, 1e-4);  // IEC 61966-2-1: ((188 / 255 + 0.055) / 1.055)^2.4
    for (int code = 0; code < 256; ++code) EXPECT_EQ(srgb_from_linear(linear_from_srgb(static_cast<std::uint8_t>(code))), code);
    for (int i = 0; i <= 100000; ++i) {
        const double light = i / 100000.0;
        const double exact = 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
        EXPECT_NEAR(srgb_from_linear(static_cast<float>(light)), exact, 0.501);
    }
    EXPECT_EQ(srgb_from_linear(-1), 0);
    EXPECT_EQ(srgb_from_linear(7), 255);
    EXPECT_EQ(srgb_from_linear(std::nanf("")), 0);
}

TEST(Reduced, MeansAreThoseOfLight) {
    const Pixels checks = painted(6, 4, [](int i, int j) {
        const std::uint8_t value = (i + j) % 2 == 0 ? 255 : 0;
        return Rgba{value, value, value, 255};
    });
    for (const auto& pixel : reduced(checks, 3, 2).rgba) EXPECT_EQ(pixel, (Rgba{188, 188, 188, 255}));  // half the light
    // Three columns to two: a pixel covers one and a half columns.
    const Pixels stripes = painted(3, 1, [](int i, int) { return Rgba{static_cast<std::uint8_t>(i == 0 ? 255 : 0), 0, 0, 255}; });
    const Pixels two = reduced(stripes, 2, 1);
    EXPECT_EQ(two.at(0, 0)[0], srgb_from_linear(2.0F / 3));
    EXPECT_EQ(two.at(1, 0)[0], 0);
}

TEST(Reduced, ColoursAreWeightedByAlpha) {
    const Pixels pixels = painted(2, 1, [](int i, int) { return i == 0 ? Rgba{200, 100, 50, 255} : Rgba{0, 255, 0, 0}; });
    EXPECT_EQ(reduced(pixels, 1, 1).at(0, 0), (Rgba{200, 100, 50, 128}));
    const Pixels clear = painted(2, 1, [](int, int) { return Rgba{10, 20, 30, 0}; });
    EXPECT_EQ(reduced(clear, 1, 1).at(0, 0), (Rgba{10, 20, 30, 0}));
}

TEST(Reduced, ConstantStaysConstant) {
    const Pixels pixels = painted(37, 23, [](int, int) { return Rgba{13, 140, 251, 99}; });
    for (const auto& [width, height] : {std::pair(37, 23), std::pair(36, 22), std::pair(17, 1), std::pair(1, 1)})
        for (const auto& pixel : reduced(pixels, width, height).rgba) EXPECT_EQ(pixel, (Rgba{13, 140, 251, 99}));
    EXPECT_THROW(reduced(pixels, 38, 23), Error);
    EXPECT_THROW(reduced(pixels, 0, 23), Error);
    EXPECT_THROW(reduced(pixels, 3, 24), Error);
}

TEST(Reduced, SameForAnyNumberOfThreads) {
    const Pixels pixels = test::gradient(301, 203);
    set_threads(1);
    const auto one = reduced(pixels, 100, 67).rgba;
    set_threads(3);
    const auto three = reduced(pixels, 100, 67).rgba;
    set_threads(0);
    EXPECT_EQ(one, three);
}

Pixels noise(int width, int height, bool translucent) {
    std::uint32_t state = 1;
    return painted(width, height, [&](int, int) {
        state = state * 1664525U + 1013904223U;
        return Rgba{static_cast<std::uint8_t>(state >> 24U), static_cast<std::uint8_t>(state >> 16U),
                    static_cast<std::uint8_t>(state >> 8U), static_cast<std::uint8_t>(translucent ? state >> 20U : 255U)};
    });
}

TEST(WithinBudget, ImagesThatFitAreUnchanged) {
    const Image image = encode(test::gradient(64, 32), ImageFormat::webp, "a.webp");
    const Image same = within_budget(image, 64, image.bytes.size(), "test");
    EXPECT_EQ(same.bytes, image.bytes);
    EXPECT_EQ(same.name, "a.webp");
}

TEST(WithinBudget, SideAndBytesAreKept) {
    const Image image = encode(noise(200, 100, false), ImageFormat::png, "folder.d/a.png");
    const Image smaller = within_budget(image, 50, 1000000, "test");
    EXPECT_EQ(smaller.format, ImageFormat::jpeg);
    EXPECT_EQ(smaller.name, "a.jpg");
    EXPECT_EQ(smaller.width, 50);
    EXPECT_EQ(smaller.height, 25);
    EXPECT_EQ(parse_image(smaller.bytes, {}, "test").width, 50);
    const Image lighter = within_budget(image, 200, 12000, "test");  // noise: the quality does not suffice
    EXPECT_LE(lighter.bytes.size(), 12000U);
    EXPECT_GT(lighter.bytes.size(), 6000U);
    EXPECT_LE(lighter.width, 200);
    EXPECT_NEAR(2.0 * lighter.height / lighter.width, 1, 0.05);
    EXPECT_THROW(within_budget(image, 200, 10, "test"), Error);
    EXPECT_THROW(within_budget(image, 0, 1000, "test"), Error);
}

TEST(WithinBudget, TranslucentImagesStayTranslucent) {
    const Image image = encode(noise(100, 100, true), ImageFormat::png, {});
    const Image smaller = within_budget(image, 100, 9000, "test");
    EXPECT_EQ(smaller.format, ImageFormat::png);
    EXPECT_LE(smaller.bytes.size(), 9000U);
    EXPECT_LT(decode(smaller, "test").at(0, 0)[3], 255);
}

}  // namespace
}  // namespace ostraka
