// The colour of a material at texture coordinates.
#include "samples.h"

#include "ostraka/core/error.h"
#include "ostraka/image/appearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ostraka {
namespace {

using test::painted;
using Rgba = std::array<std::uint8_t, 4>;
using Light = std::array<float, 4>;

/// One material with this image.
Appearance look_of(const Pixels& pixels, TextureWrap wrap_u = TextureWrap::repeat, TextureWrap wrap_v = TextureWrap::repeat) {
    Appearance look;
    look.images.push_back(std::make_shared<Image>(encode(pixels, ImageFormat::png, "a.png")));
    look.materials.emplace_back();
    look.materials[0].image = 0;
    look.materials[0].wrap_u = wrap_u;
    look.materials[0].wrap_v = wrap_v;
    return look;
}

/// Four columns of 0, 80, 160, 240 of red; three rows of 10, 100, 200 of green from the top.
Pixels columns_and_rows() {
    return painted(4, 3, [](int i, int j) {
        return Rgba{static_cast<std::uint8_t>(80 * i), static_cast<std::uint8_t>(j == 0 ? 10 : 100 * j), 0, 255};
    });
}

float red(int column) { return linear_from_srgb(static_cast<std::uint8_t>(80 * column)); }

TEST(Texture, TexelCentresAndRowsFromTheTop) {
    const TextureSampler sampler(look_of(columns_and_rows()), "test");
    EXPECT_EQ(sampler.size(0), (std::array<int, 2>{4, 3}));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const Light colour = sampler.colour(0, {(float(column) + 0.5F) / 4, 1 - (float(row) + 0.5F) / 3});
            EXPECT_NEAR(colour[0], red(column), 1e-6);
            EXPECT_NEAR(colour[1], linear_from_srgb(static_cast<std::uint8_t>(row == 0 ? 10 : 100 * row)), 1e-6);
            EXPECT_EQ(colour[3], 1);
        }
    // Half-way between two centres, in linear light.
    EXPECT_NEAR(sampler.colour(0, {0.5F, 0.5F})[0], (red(1) + red(2)) / 2, 1e-6);
}

TEST(Texture, WrappedAtTheBorders) {
    const auto value = [](TextureWrap wrap, float u) {
        return TextureSampler(look_of(columns_and_rows(), wrap), "test").colour(0, {u, 0.5F})[0];
    };
    EXPECT_NEAR(value(TextureWrap::repeat, 0), (red(0) + red(3)) / 2, 1e-6);
    EXPECT_NEAR(value(TextureWrap::repeat, 1), (red(0) + red(3)) / 2, 1e-6);
    EXPECT_NEAR(value(TextureWrap::clamp, 0), red(0), 1e-6);
    EXPECT_NEAR(value(TextureWrap::clamp, 1), red(3), 1e-6);
    EXPECT_NEAR(value(TextureWrap::mirror, 0), red(0), 1e-6);
    EXPECT_NEAR(value(TextureWrap::mirror, 1), red(3), 1e-6);
    for (int column = 0; column < 4; ++column) {
        const float centre = (float(column) + 0.5F) / 4;
        for (const float whole : {-1000.0F, -2.0F, 2.0F, 17.0F, 64.0F}) {
            EXPECT_NEAR(value(TextureWrap::repeat, whole + centre), red(column), 1e-4);
            EXPECT_NEAR(value(TextureWrap::clamp, whole + centre), red(whole < 0 ? 0 : 3), 1e-6);
            const bool mirrored = std::fmod(std::abs(whole), 2) == 1;
            EXPECT_NEAR(value(TextureWrap::mirror, whole + centre), red(mirrored ? 3 - column : column), 1e-4);
        }
    }
    const TextureSampler vertical(look_of(columns_and_rows(), TextureWrap::repeat, TextureWrap::mirror), "test");
    EXPECT_NEAR(vertical.colour(0, {0.5F, 1 + 0.5F / 3})[1], linear_from_srgb(10), 1e-6);  // above: the top row again
    EXPECT_NEAR(vertical.colour(0, {0.5F, -0.5F / 3})[1], linear_from_srgb(200), 1e-6);    // below: the bottom row again
}

TEST(Texture, NearestPixels) {
    Appearance look = look_of(columns_and_rows());
    look.materials[0].nearest = true;
    const TextureSampler sampler(look, "test");
    for (int i = 0; i < 40; ++i) EXPECT_EQ(sampler.colour(0, {(float(i) + 0.5F) / 40, 0.9F})[0], red(i / 10));
    EXPECT_EQ(sampler.colour(0, {1, 1})[0], red(0));  // repeated
    look.materials[0].wrap_u = TextureWrap::clamp;
    EXPECT_EQ(TextureSampler(look, "test").colour(0, {1, 0.9F})[0], red(3));
}

TEST(Texture, BaseColourAndMissingImages) {
    Appearance look = look_of(painted(2, 2, [](int, int) { return Rgba{255, 188, 0, 51}; }));
    look.materials[0].base_colour = {0.5F, 1, 1, 0.5F};
    look.images.push_back(nullptr);
    look.materials.emplace_back();
    look.materials[1].base_colour = {0.1F, 0.2F, 0.3F, 0.4F};
    look.materials[1].image = 1;
    look.materials.push_back(look.materials[1]);
    look.materials[2].image = no_index;
    look.materials.push_back(look.materials[1]);
    look.materials[3].image = 99;
    const TextureSampler sampler(look, "test");
    const Light colour = sampler.colour(0, {0.3F, 0.3F});
    EXPECT_NEAR(colour[0], 0.5, 1e-6);
    EXPECT_NEAR(colour[1], linear_from_srgb(188), 1e-6);
    EXPECT_NEAR(colour[3], 0.1, 1e-6);
    for (Index material = 1; material < 4; ++material) {
        EXPECT_EQ(sampler.colour(material, {0.3F, 0.3F}), look.materials[1].base_colour);
        EXPECT_EQ(sampler.size(material), (std::array<int, 2>{0, 0}));
    }
    EXPECT_EQ(sampler.colour(no_index, {0, 0}), (Light{1, 1, 1, 1}));
    EXPECT_EQ(sampler.size(no_index), (std::array<int, 2>{0, 0}));
}

TEST(Texture, FootprintsGiveMeansOfLight) {
    const Pixels checks = painted(64, 64, [](int i, int j) {
        const std::uint8_t value = (i + j) % 2 == 0 ? 255 : 0;
        return Rgba{value, value, value, 255};
    });
    const TextureSampler sampler(look_of(checks), "test");
    for (const float footprint : {2.0F / 64, 3.0F / 64, 0.5F, 1.0F, 100.0F, std::numeric_limits<float>::infinity()})
        EXPECT_NEAR(sampler.colour(0, {0.31F, 0.77F}, footprint)[0], 0.5, 1e-4) << footprint;
    // Between a pixel and two pixels, the share of the smaller image grows with the logarithm.
    const float centre = 0.5F / 64;
    EXPECT_NEAR(sampler.colour(0, {centre, 1 - centre}, std::sqrt(2.0F) / 64)[0], 0.75, 1e-4);
    EXPECT_NEAR(sampler.colour(0, {centre, 1 - centre}, 0.9F / 64)[0], 1, 1e-6);
}

TEST(Texture, PyramidOfOddSizes) {
    // The mean of the whole image at its top, whatever the sides.
    const Pixels pixels = painted(7, 5, [](int i, int j) {
        return Rgba{static_cast<std::uint8_t>(30 * i), 0, 0, static_cast<std::uint8_t>(50 * j)};
    });
    double light = 0;
    for (const auto& pixel : pixels.rgba) light += linear_from_srgb(pixel[0]) / 35.0;
    const Light colour = TextureSampler(look_of(pixels), "test").colour(0, {0.2F, 0.2F}, 50);
    EXPECT_NEAR(colour[0], light, 1e-4);
    EXPECT_NEAR(colour[3], 100.0 / 255, 1e-4);
    const TextureSampler single(look_of(painted(1, 1, [](int, int) { return Rgba{255, 0, 0, 255}; })), "test");
    EXPECT_EQ(single.colour(0, {3, 4}, 2), (Light{1, 0, 0, 1}));
}

TEST(Texture, AnyCoordinates) {
    const float infinity = std::numeric_limits<float>::infinity(), largest = std::numeric_limits<float>::max();
    for (const auto wrap : {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror}) {
        Appearance look = look_of(columns_and_rows(), wrap, wrap);
        for (const bool nearest : {false, true}) {
            look.materials[0].nearest = nearest;
            const TextureSampler sampler(look, "test");
            for (const float u : {infinity, -infinity, largest, -largest, std::nanf(""), -1e-30F, 1e-30F, 1.0F, -0.0F})
                for (const float footprint : {0.0F, 0.6F, infinity, std::nanf(""), -1.0F})
                    for (const float channel : sampler.colour(0, {u, u}, footprint)) {
                        EXPECT_GE(channel, 0);
                        EXPECT_LE(channel, 1);
                    }
        }
    }
}

TEST(Texture, DamagedImagesAreNamed) {
    Appearance look = look_of(columns_and_rows());
    Image damaged = *look.images[0];
    damaged.bytes.resize(damaged.bytes.size() / 2);
    look.images[0] = std::make_shared<Image>(damaged);
    try {
        TextureSampler(look, "pot.glb");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_EQ(error.where(), "pot.glb");
    }
    look.materials[0].image = no_index;  // an image of no material is not decoded
    EXPECT_EQ(TextureSampler(look, "pot.glb").colour(0, {0, 0}), (Light{1, 1, 1, 1}));
}

}  // namespace
}  // namespace ostraka
