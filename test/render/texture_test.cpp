// Textures in pictures: what a camera that looks straight at a square must see.
#include "ostraka/render/render.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "read_png.h"
#include "scenes.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ostraka {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

constexpr Rgba red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255}, white{255, 255, 255, 255}, black{0, 0, 0, 255};

SharedImage png_of(int width, int height, const std::function<Rgba(int, int)>& colour) {
    Pixels pixels{width, height, {}};
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) pixels.rgba.push_back(colour(column, row));
    return std::make_shared<const Image>(encode(pixels, ImageFormat::png, "test.png"));
}

Appearance appearance_of(const SharedImage& image) {
    Appearance appearance;
    appearance.images = {image};
    appearance.materials.emplace_back().image = 0;
    return appearance;
}

/// The square [0, 1] x [0, 1] in the plane y = 0, seen from the front; its texture coordinates are x and z, scaled.
Scene square(const Appearance& appearance, float repeats = 1) {
    Scene scene;
    scene.mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.texture = std::make_shared<const TextureSampler>(appearance, "test");
    for (const auto& triangle : scene.mesh.triangles)
        for (const Index v : triangle)
            scene.corner_texture.push_back(
                {repeats * static_cast<float>(scene.mesh.points[v][0]), repeats * static_cast<float>(scene.mesh.points[v][2])});
    return scene;
}

RenderOptions flat(const std::string& size = "200x200") {
    RenderOptions options;
    options.size = size;
    options.view = "front";
    options.light = RenderOptions::Light::flat;
    options.transparent = options.no_scale_bar = options.no_legend = true;
    return options;
}

/// Red, green and blue of the pixel that shows the point (x, 0, z).
std::array<int, 3> seen_at(const Rendering& rendering, double x, double z) {
    const auto place = rendering.panes[0].camera.project(Point(x, 0, z));
    const std::uint32_t pixel =
        rendering.picture.at(static_cast<int>(std::floor((*place)[0])), static_cast<int>(std::floor((*place)[1])));
    EXPECT_EQ(pixel >> 24U, 255U);
    return {static_cast<int>(pixel >> 16U & 255U), static_cast<int>(pixel >> 8U & 255U), static_cast<int>(pixel & 255U)};
}

void expect_near(const std::array<int, 3>& seen, const std::array<int, 3>& expected, int tolerance) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], expected[k], tolerance) << "channel " << k;
}

std::array<int, 3> rgb(const Rgba& colour) { return {colour[0], colour[1], colour[2]}; }

double linear(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }
double coded(double light) { return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055; }

TEST(Texture, EveryGreyOfTheImageIsSeenExactly) {
    Appearance appearance = appearance_of(png_of(16, 16, [](int column, int row) {
        const auto grey = static_cast<std::uint8_t>(16 * row + column);
        return Rgba{grey, static_cast<std::uint8_t>(255 - grey), 7, 255};
    }));
    appearance.materials[0].nearest = true;
    const Rendering rendering = render({square(appearance)}, flat("400x400"));
    for (int row = 0; row < 16; ++row)
        for (int column = 0; column < 16; ++column)
            EXPECT_EQ(seen_at(rendering, (column + 0.5) / 16, 1 - (row + 0.5) / 16),
                      (std::array<int, 3>{16 * row + column, 255 - 16 * row - column, 7}));
}

TEST(Texture, IsInterpolatedInLinearLight) {
    Appearance appearance = appearance_of(png_of(2, 1, [](int column, int) { return column == 0 ? black : white; }));
    appearance.materials[0].wrap_u = TextureWrap::clamp;
    const Rendering rendering = render({square(appearance)}, flat());
    // Between the centres of the two pixels of the image, at x = 0.25 and 0.75, light grows linearly.
    for (const double x : {0.3, 0.4, 0.5, 0.6, 0.7}) {
        const auto place = rendering.panes[0].camera.project(Point(x, 0, 0.5));
        const PictureCamera::Ray ray =
            rendering.panes[0].camera.ray(std::floor((*place)[0]) + 0.5, std::floor((*place)[1]) + 0.5);
        const int expected = static_cast<int>(std::lround(255 * coded((ray.origin.x() - 0.25) / 0.5)));
        expect_near(seen_at(rendering, x, 0.5), {expected, expected, expected}, 2);
    }
    expect_near(seen_at(rendering, 0.2, 0.5), {0, 0, 0}, 0);
    expect_near(seen_at(rendering, 0.8, 0.5), {255, 255, 255}, 0);
}

TEST(Texture, AFineCheckerIsTheMeanGreyFromAfar) {
    const int mean = static_cast<int>(std::lround(255 * coded(0.5)));
    const auto checker = png_of(512, 512, [](int column, int row) { return (column + row) % 2 == 0 ? white : black; });
    for (const char* size : {"40x40", "70x70", "100x100"})
        for (const int samples : {1, 8}) {
            RenderOptions options = flat(size);
            options.samples = samples;
            const Rendering rendering = render({square(appearance_of(checker))}, options);
            for (double x = 0.1; x < 0.95; x += 0.1)
                for (double z = 0.1; z < 0.95; z += 0.1) expect_near(seen_at(rendering, x, z), {mean, mean, mean}, 4);
        }
}

TEST(Texture, ChartsDoNotBleedIntoEachOther) {
    // Two charts without a gutter between them in the image, far apart on the object; black beyond them.
    const auto atlas = png_of(999, 333, [](int column, int row) {
        return row >= 200 ? black : column < 331 ? red : column < 777 ? blue : black;
    });
    Scene scene;
    scene.mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {3, 0, 0}, {4, 0, 0}, {4, 0, 1}, {3, 0, 1}};
    scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    scene.texture = std::make_shared<const TextureSampler>(appearance_of(atlas), "test");
    const std::array<float, 2> begin{0, 331.0F / 999}, end{331.0F / 999, 777.0F / 999};
    const float bottom = 1 - 200.0F / 333;
    for (const auto& triangle : scene.mesh.triangles)
        for (const Index v : triangle) {
            const std::size_t chart = v / 4;
            const auto& p = scene.mesh.points[v];
            const float u = begin[chart] + static_cast<float>(p[0] - 3.0 * double(chart)) * (end[chart] - begin[chart]);
            scene.corner_texture.push_back({u, bottom + static_cast<float>(p[2]) * (1 - bottom)});
        }
    const Rendering rendering = render({scene}, flat("100x60"));
    const double pixel = 1 / rendering.panes[0].pixels_per_unit;
    for (double x = 1.01 * pixel; x < 1 - pixel; x += pixel)
        for (double z = 1.01 * pixel; z < 1 - pixel; z += pixel) {
            expect_near(seen_at(rendering, x, z), rgb(red), 12);
            expect_near(seen_at(rendering, 3 + x, z), rgb(blue), 12);
        }
}

TEST(Texture, ASeamBetweenChartsIsSharp) {
    // The two triangles of the square are charts of the same colour at the two ends of an image that is black between them.
    const auto atlas = png_of(512, 64, [](int column, int) { return column < 128 || column >= 384 ? green : black; });
    Scene scene = square(appearance_of(atlas));
    scene.corner_texture = {{0, 0}, {0.24F, 0}, {0.24F, 1}, {0.76F, 0}, {1, 1}, {0.76F, 1}};
    const Rendering rendering = render({scene}, flat("150x150"));
    for (double t = 0.05; t < 0.96; t += 0.01) expect_near(seen_at(rendering, t, t), rgb(green), 0);
}

TEST(Texture, OutsideItsSquareAnImageIsRepeatedClampedOrMirrored) {
    const auto image = png_of(4, 1, [](int column, int) { return column == 0 ? red : column == 3 ? blue : white; });
    const std::array<std::pair<TextureWrap, std::array<Rgba, 2>>, 3> cases{
        {{TextureWrap::repeat, {red, blue}}, {TextureWrap::clamp, {blue, blue}}, {TextureWrap::mirror, {blue, red}}}};
    for (const auto& [wrap, expected] : cases) {
        Appearance appearance = appearance_of(image);
        appearance.materials[0].wrap_u = wrap;
        appearance.materials[0].nearest = true;
        const Rendering rendering = render({square(appearance, 2)}, flat());
        EXPECT_EQ(seen_at(rendering, 0.5 / 8, 0.3), rgb(red));
        EXPECT_EQ(seen_at(rendering, 3.5 / 8, 0.3), rgb(blue));
        EXPECT_EQ(seen_at(rendering, 4.5 / 8, 0.3), rgb(expected[0]));
        EXPECT_EQ(seen_at(rendering, 7.5 / 8, 0.3), rgb(expected[1]));
    }
}

TEST(Texture, ColoursMultiplyTheTexture) {
    const Rgba grey{128, 128, 128, 255};
    Scene scene = square(appearance_of(png_of(2, 2, [&](int, int) { return grey; })));
    scene.vertex_colours.assign(4, Rgb{255, 128, 0});
    const auto product = [](int a, int b) {
        return static_cast<int>(std::lround(255 * coded(linear(a / 255.0) * linear(b / 255.0))));
    };
    expect_near(seen_at(render({scene}, flat()), 0.4, 0.6), {128, product(128, 128), 0}, 1);
    scene.face_colours.assign(2, Rgb{0, 255, 128});
    expect_near(seen_at(render({scene}, flat()), 0.4, 0.6), {0, 128, product(128, 128)}, 1);
}

TEST(Texture, FacesWithoutAMaterialAreClayOrHaveTheirOwnColour) {
    Appearance appearance = appearance_of(png_of(1, 1, [](int, int) { return blue; }));
    appearance.materials.emplace_back().base_colour = {1, 0, 0, 1};
    Scene scene = square(appearance);
    scene.face_materials = {1, no_index};
    EXPECT_EQ(seen_at(render({scene}, flat()), 0.7, 0.2), rgb(red));
    EXPECT_EQ(seen_at(render({scene}, flat()), 0.2, 0.7), (std::array<int, 3>{clay.red, clay.green, clay.blue}));
    scene.face_colours.assign(2, Rgb{9, 8, 7});
    EXPECT_EQ(seen_at(render({scene}, flat()), 0.2, 0.7), (std::array<int, 3>{9, 8, 7}));
    scene.face_materials = {0, 0};
    scene.face_colours.clear();
    scene.corner_texture.clear();  // no texture coordinates: the colour of the material alone
    EXPECT_EQ(seen_at(render({scene}, flat()), 0.2, 0.7), rgb(white));
}

TEST(Texture, WhatIsTransparentShowsWhatIsBehind) {
    const auto holes = png_of(2, 1, [](int column, int) { return column == 0 ? Rgba{255, 0, 0, 20} : red; });
    Appearance appearance = appearance_of(holes);
    appearance.materials[0].nearest = true;
    appearance.materials.emplace_back().base_colour = {0, 0, 1, 1};
    Scene scene = square(appearance);
    for (const Index v : {0U, 1U, 2U, 3U}) {
        auto behind = scene.mesh.points[v];
        behind[1] = 0.5;
        scene.mesh.points.push_back(behind);
    }
    scene.mesh.triangles.insert(scene.mesh.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
    scene.corner_texture.resize(12, TexturePoint{0, 0});
    scene.face_materials = {0, 0, 1, 1};
    const auto with = [&](Material::Alpha alpha) {
        Appearance changed = appearance;
        changed.materials[0].alpha = alpha;
        scene.texture = std::make_shared<const TextureSampler>(changed, "test");
        return render({scene}, flat());
    };
    EXPECT_EQ(seen_at(with(Material::Alpha::opaque), 0.25, 0.5), rgb(red));
    EXPECT_EQ(seen_at(with(Material::Alpha::mask), 0.25, 0.5), rgb(blue));
    EXPECT_EQ(seen_at(with(Material::Alpha::mask), 0.75, 0.5), rgb(red));
    const double share = 20.0 / 255;
    expect_near(seen_at(with(Material::Alpha::blend), 0.25, 0.5),
                {static_cast<int>(std::lround(255 * coded(share))), 0, static_cast<int>(std::lround(255 * coded(1 - share)))}, 1);
}

TEST(Texture, IsTheSameForAnyNumberOfThreadsAndFromTheSide) {
    const auto image = png_of(256, 256, [](int column, int row) {
        return Rgba{static_cast<std::uint8_t>(column), static_cast<std::uint8_t>(row), static_cast<std::uint8_t>(7 * column),
                    255};
    });
    RenderOptions options = flat();
    options.view = "55,35";
    options.light = RenderOptions::Light::shaded;
    const std::vector<Scene> scenes{square(appearance_of(image))};
    set_threads(1);
    const Rendering sequential = render(scenes, options);
    set_threads(3);
    EXPECT_EQ(sequential.picture.argb, render(scenes, options).picture.argb);
    set_threads(0);
    options.projection = RenderOptions::Projection::perspective;
    EXPECT_GT(test::covered(render(scenes, options).picture), 1000);
}

TEST(Texture, FlatLightShowsColoursAsTheyAre) {
    Scene scene = test::sphere(24);
    scene.vertex_colours.assign(scene.mesh.points.size(), Rgb{120, 60, 30});
    RenderOptions options = flat();
    std::size_t inside = 0;
    const Rendering rendering = render({scene}, options);
    for (const std::uint32_t pixel : rendering.picture.argb)
        if (pixel >> 24U == 255U) {
            EXPECT_EQ(pixel, 0xFF783C1EU);
            ++inside;
        }
    EXPECT_GT(inside, 10000U);
    options.ambient_occlusion = 8;
    EXPECT_THROW(render({scene}, options), Error);
}

TEST(Texture, PointsHaveTheColourOfTheTexture) {
    Scene scene = square(appearance_of(png_of(2, 2, [](int, int) { return green; })));
    RenderOptions options = flat();
    options.drawing = RenderOptions::Drawing::points;
    std::size_t dots = 0;
    const Rendering rendering = render({scene}, options);
    for (const std::uint32_t pixel : rendering.picture.argb) dots += (pixel & 0xFF00FFU) == 0 && (pixel & 0xFF00U) != 0 ? 1 : 0;
    EXPECT_GT(dots, 0U);
}

TEST(Texture, ListsThatDoNotFitAreRefused) {
    const auto image = png_of(2, 2, [](int, int) { return green; });
    Scene scene = square(appearance_of(image));
    scene.corner_texture.pop_back();
    EXPECT_THROW(render({scene}, flat()), Error);
    scene = square(appearance_of(image));
    scene.face_materials = {0, 1};
    EXPECT_THROW(render({scene}, flat()), Error);
    scene.face_materials = {0};
    EXPECT_THROW(render({scene}, flat()), Error);
    scene = square(appearance_of(image));
    scene.corner_texture[1] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
    EXPECT_EQ(seen_at(render({scene}, flat()), 0.7, 0.2), rgb(white));  // the material without its image
}

// ---- size on paper ----

/// A cube of 20 mm.
Scene cube_of_20_mm() {
    Scene scene = test::moved(test::cube(), 10, {3, 4, 5});
    scene.unit = "mm";
    scene.unit_metres = 1e-3;
    return scene;
}

TEST(PrintScale, AnObjectHasItsSizeOnPaper) {
    RenderOptions options = flat("600x400");
    options.dpi = 254;  // 10 pixels per millimetre
    for (const auto& [scale, factor] : {std::pair{"1:1", 1.0}, std::pair{"1:2", 0.5}, std::pair{"3:2", 1.5}}) {
        options.print_scale = scale;
        const Rendering rendering = render({cube_of_20_mm()}, options);
        EXPECT_NEAR(rendering.panes[0].pixels_per_unit, 10 * factor, 1e-9);
        EXPECT_NEAR(rendering.pixels_per_metre, 10000, 1e-9);
        double width = 0;
        for (int column = 0; column < 600; ++column) width += static_cast<double>(rendering.picture.at(column, 200) >> 24U) / 255;
        EXPECT_NEAR(width, 200 * factor, 1);
    }
    options.print_scale = "3:1";  // 600 pixels
    try {
        render({cube_of_20_mm()}, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("--size"), std::string::npos) << error.what();
    }
}

TEST(PrintScale, IsRefusedWhereItMeansNothing) {
    RenderOptions options = flat();
    options.print_scale = "1:2";
    Scene scene = cube_of_20_mm();
    scene.unit_metres = 0;
    EXPECT_THROW(render({scene}, options), Error);
    options.zoom = 2;
    EXPECT_THROW(render({cube_of_20_mm()}, options), Error);
    options.zoom = 1;
    options.projection = RenderOptions::Projection::perspective;
    EXPECT_THROW(render({cube_of_20_mm()}, options), Error);
    for (const char* text : {"2", "1:0", "0:1", "-1:2", "1:2:3", "a:b", "1e300:1e-300", "nan:1"})
        EXPECT_THROW(parse_print_scale(text), Error) << text;
    EXPECT_EQ(parse_print_scale(""), 0);
    EXPECT_EQ(parse_print_scale("1:4"), 0.25);
}

TEST(PrintScale, TheSizeOnPaperIsWrittenIntoTheFile) {
    const test::Scratch scratch;
    RenderOptions options = flat("200x100");
    options.dpi = 300;
    const Rendering pixels = render({cube_of_20_mm()}, options);
    write_png(scratch / "a.png", pixels.picture, pixels.pixels_per_metre);
    const std::string bytes = read_file(scratch / "a.png");
    const std::size_t chunk = bytes.find("pHYs");
    ASSERT_NE(chunk, std::string::npos);
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) value = value << 8U | static_cast<std::uint8_t>(bytes[chunk + at + k]);
        return value;
    };
    EXPECT_EQ(number(4), 11811U);  // 300 / 0.0254
    EXPECT_EQ(number(8), 11811U);
    EXPECT_EQ(bytes[chunk + 12], 1);
    EXPECT_EQ(test::read_png(scratch / "a.png").argb, pixels.picture.argb);  // its checksum is right
    write_png(scratch / "b.png", pixels.picture);
    EXPECT_EQ(read_file(scratch / "b.png").find("pHYs"), std::string::npos);
    // 200 pixels of 1/300 inch are 48 points.
    const std::string svg = render({cube_of_20_mm()}, options, PictureKind::svg).document;
    EXPECT_NE(svg.find("width=\"48pt\""), std::string::npos) << svg.substr(0, 300);
    EXPECT_NE(svg.find("height=\"24pt\""), std::string::npos);
    const std::string pdf = render({cube_of_20_mm()}, options, PictureKind::pdf).document;
    EXPECT_NE(pdf.find("/MediaBox [ 0 0 48 24 ]"), std::string::npos);
    options.dpi = 0;
    const std::string plain = render({cube_of_20_mm()}, options, PictureKind::svg).document;
    EXPECT_NE(plain.find("width=\"200px\""), std::string::npos) << plain.substr(0, 300);
}

}  // namespace
}  // namespace ostraka
