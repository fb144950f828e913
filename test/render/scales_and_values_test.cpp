#include "mutate.h"
#include "ostraka/core/error.h"
#include "ostraka/render/colour_scale.h"
#include "ostraka/render/picture.h"
#include "ostraka/render/values.h"
#include "ostraka/render/view.h"
#include "read_png.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

namespace ostraka {
namespace {

double lightness(const Rgb& colour) {
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(colour.red / 255.0) + 0.7152 * linear(colour.green / 255.0) + 0.0722 * linear(colour.blue / 255.0);
}

TEST(ColourScale, LightnessIncreases) {
    const ColourScale scale{-1, 3, false, ""};
    double previous = -1;
    for (int i = 0; i <= 64; ++i) {
        const double current = lightness(colour_of(scale, -1 + i / 16.0));
        EXPECT_GT(current, previous);
        previous = current;
    }
    EXPECT_EQ(colour_of(scale, -9), colour_of(scale, -1));
    EXPECT_EQ(colour_of(scale, 99), colour_of(scale, 3));
}

TEST(ColourScale, SignedValuesDivergeAboutZero) {
    const std::vector<double> values{-1, 4, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    const ColourScale scale = scale_of({&values}, "map");
    EXPECT_TRUE(scale.diverging);
    EXPECT_EQ(scale.minimum, -4);
    EXPECT_EQ(scale.maximum, 4);
    EXPECT_GT(lightness(colour_of(scale, 0)), lightness(colour_of(scale, 3)));
    EXPECT_GT(lightness(colour_of(scale, 0)), lightness(colour_of(scale, -3)));
    const std::vector<double> no_values{std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THROW((void)scale_of({&no_values}, "map"), Error);
}

TEST(ColourScale, ConstantAndExtremeValues) {
    const std::vector<double> constant{5, 5};
    EXPECT_NO_THROW((void)colour_of(scale_of({&constant}, "map"), 5));
    EXPECT_EQ(ticks(scale_of({&constant}, "map"), 7), std::vector<double>{5});
    const ColourScale extreme{-1.7e308, 1.7e308, true, ""};
    EXPECT_EQ(colour_of(extreme, 0), colour_of(ColourScale{-1, 1, true, ""}, 0));
    EXPECT_LE(ticks(extreme, 7).size(), 29U);
}

TEST(ColourScale, TicksAreRoundAndInside) {
    for (const auto& [low, high] : {std::pair{0.0, 1.0}, {2.37, 2.41}, {-3.0, 3.0}, {1e-7, 4e-7}, {12345.0, 99999.0}}) {
        const auto positions = ticks({low, high, false, ""}, 7);
        ASSERT_GE(positions.size(), 3U);
        EXPECT_LE(positions.size(), 12U);
        const double step = positions[1] - positions[0];
        EXPECT_NEAR(round_length(step * (1 + 1e-6)) / step, 1, 1e-5);
        for (const double tick : positions) {
            EXPECT_GE(tick, low - 1e-9 * step);
            EXPECT_LE(tick, high + 1e-9 * step);
            EXPECT_NEAR(std::remainder(tick, step) / step, 0, 1e-6);
        }
    }
    EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
    EXPECT_EQ(tick_text(2.5, 0.5), "2.5");
    EXPECT_EQ(tick_text(20, 10), "20");
}

TEST(ColourScale, RoundLengths) {
    EXPECT_EQ(round_length(1), 1);
    EXPECT_EQ(round_length(4.99), 2);
    EXPECT_EQ(round_length(99), 50);
    EXPECT_EQ(round_length(0.012), 0.01);
    EXPECT_EQ(round_length(0), 0);
    EXPECT_EQ(round_length(std::numeric_limits<double>::infinity()), 0);
    EXPECT_GT(round_length(1e308), 0);
    EXPECT_GT(round_length(1e-300), 0);
}

/// CIE L*a*b* of a colour as seen with one type of colour vision: `eye` is a matrix on linear red, green and blue (Machado,
/// Oliveira and Fernandes 2009).
std::array<double, 3> lab(const Rgb& colour, const std::array<std::array<double, 3>, 3>& eye) {
    std::array<double, 3> linear{}, perceived{};
    const std::array<int, 3> channels{colour.red, colour.green, colour.blue};
    for (std::size_t k = 0; k < 3; ++k) {
        const double c = channels[k] / 255.0;
        linear[k] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    for (std::size_t i = 0; i < 3; ++i)
        perceived[i] = std::clamp(eye[i][0] * linear[0] + eye[i][1] * linear[1] + eye[i][2] * linear[2], 0.0, 1.0);
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    const double x = f((0.4124 * perceived[0] + 0.3576 * perceived[1] + 0.1805 * perceived[2]) / 0.95047),
                 y = f(0.2126 * perceived[0] + 0.7152 * perceived[1] + 0.0722 * perceived[2]),
                 z = f((0.0193 * perceived[0] + 0.1192 * perceived[1] + 0.9505 * perceived[2]) / 1.08883);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(CategoryColours, AreDistinguishableForColourBlindReaders) {
    const std::array<std::array<std::array<double, 3>, 3>, 4> eyes{
        {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
         {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
         {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
         {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};
    for (const auto& eye : eyes)
        for (std::size_t i = 0; i < category_hues; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const auto a = lab(category_colour(i), eye), b = lab(category_colour(j), eye);
                EXPECT_GT(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]), 15) << i << ' ' << j;
            }
    std::set<std::array<int, 3>> colours;
    for (std::size_t i = 0; i < category_count; ++i) {
        const Rgb colour = category_colour(i);
        colours.insert({colour.red, colour.green, colour.blue});
        // Muted: no channel is at its maximum while another is at its minimum.
        EXPECT_LT(std::max({colour.red, colour.green, colour.blue}) - std::min({colour.red, colour.green, colour.blue}), 110);
    }
    EXPECT_EQ(colours.size(), category_count);
    EXPECT_EQ(category_colour(category_count), category_colour(0));
}

TEST(View, AxesAreRightHandedAndStandardViewsExact) {
    for (const char* up : {"x", "y", "z", "-x", "-y", "-z", "1,2,3"})
        for (const char* name : {"front", "top", "iso", "33,-71"}) {
            const ViewAxes a = view_axes(parse_view(name), parse_up(up));
            const auto dot = [](const auto& p, const auto& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
            EXPECT_NEAR(dot(a.right, a.right), 1, 1e-12);
            EXPECT_NEAR(dot(a.up, a.up), 1, 1e-12);
            EXPECT_NEAR(dot(a.right, a.up), 0, 1e-12);
            EXPECT_NEAR(a.right[0] * a.up[1] - a.right[1] * a.up[0], a.toward[2], 1e-12);
        }
    using Triple = std::array<double, 3>;
    EXPECT_EQ(view_axes(parse_view("front"), parse_up("z")).toward, (Triple{0, -1, 0}));
    EXPECT_EQ(view_axes(parse_view("front"), parse_up("z")).right, (Triple{1, 0, 0}));
    EXPECT_EQ(view_axes(parse_view("right"), parse_up("z")).toward, (Triple{1, 0, 0}));
    EXPECT_EQ(view_axes(parse_view("front"), parse_up("y")).toward, (Triple{0, 0, 1}));
    EXPECT_EQ(view_axes(parse_view("top"), parse_up("y")).toward, (Triple{0, 1, 0}));
    EXPECT_EQ(view_axes(parse_view("0,0"), parse_up("z")).toward, view_axes(parse_view("front"), parse_up("auto")).toward);
}

TEST(PictureFile, PngRoundTripIsExact) {
    const test::Scratch folder;
    Picture picture{5, 3, {}};
    for (std::uint32_t i = 0; i < 15; ++i) picture.argb.push_back(i % 3 == 0 ? 0 : 0xFF000000U | i * 0x0F1307U);
    const Path file = folder / "a.png";
    write_png(file, picture);
    EXPECT_EQ(read_file(file).substr(0, 8), "\x89PNG\r\n\x1a\n");
    const Picture reread = test::read_png(file);
    EXPECT_EQ(reread.width, 5);
    EXPECT_EQ(reread.argb, picture.argb);
}

std::string npy(const std::string& type, const std::string& shape, const std::string& data) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
    header.resize(117, ' ');
    header += '\n';
    return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header + data;
}
template <class Number>
std::string raw(std::initializer_list<Number> numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.begin(), bytes.size());
    return bytes;
}

TEST(Values, NumpyArrays) {
    const test::Scratch folder;
    const Path file = folder / "v.npy";
    write_file(file, npy("<f8", "(3,)", raw<double>({1.5, -2, 1e300})));
    EXPECT_EQ(read_values(file), (std::vector<double>{1.5, -2, 1e300}));
    write_file(file, npy("<f4", "(2, 1)", raw<float>({0.5F, 3})));
    EXPECT_EQ(read_values(file), (std::vector<double>{0.5, 3}));
    write_file(file, npy("<i4", "(2,)", raw<std::int32_t>({-7, 9})));
    EXPECT_EQ(read_values(file), (std::vector<double>{-7, 9}));
    for (const std::string& invalid :
         {npy("<f8", "(4,)", raw<double>({1, 2, 3})), npy("<f8", "(1000000000000,)", raw<double>({1})),
          npy("<f8", "(2, 2)", raw<double>({1, 2, 3, 4})), npy("<f8", "()", raw<double>({1})),
          npy(">f8", "(1,)", raw<double>({1})), npy("<c16", "(1,)", raw<double>({1, 2})), npy("<f8", "(1,)", "abc"),
          npy("<f8", "(99999999999999999999,)", ""), npy("<f8", "(1,", ""), std::string("\x93NUMPY"), std::string(),
          npy("<f8", "(1,)", raw<double>({1})).substr(0, 60), npy("<f8", "(x)", "")}) {
        write_file(file, invalid);
        EXPECT_THROW((void)read_values(file), Error);
    }
}

TEST(Values, Text) {
    const test::Scratch folder;
    const Path file = folder / "v.txt";
    write_file(file, "# thickness\n1\r\n  2.5e-3\n\n-4\nnan\n+7");
    const auto values = read_values(file);
    ASSERT_EQ(values.size(), 5U);
    EXPECT_EQ(values[1], 2.5e-3);
    EXPECT_TRUE(std::isnan(values[3]));
    EXPECT_EQ(values[4], 7);
    write_file(file, "1\n2 3\n");
    try {
        (void)read_values(file);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(error.where().find("line 2"), std::string::npos);
    }
    EXPECT_THROW((void)read_values(folder / "missing.txt"), Error);
}

TEST(Values, DamagedFilesGiveNumbersOrAnError) {
    const test::Scratch folder;
    const std::string valid_npy = npy("<f8", "(5,)", raw<double>({1, 2, 3, 4, 5})), valid_text = "# map\n1.5\n2\nnan\n-4e3\n";
    for (std::size_t i = 0; i < 200; ++i)
        for (const bool binary : {true, false}) {
            const Path file =
                folder.file(std::to_string(i) + (binary ? ".npy" : ".txt"), test::mutate(binary ? valid_npy : valid_text, i));
            try {
                EXPECT_LT(read_values(file).size(), 100U);
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input);
            }
        }
}

}  // namespace
}  // namespace ostraka
