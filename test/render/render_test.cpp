#include "ostraka/render/render.h"

#include "ostraka/core/parallel.h"
#include "scenes.h"

#include <gtest/gtest.h>
#include <set>

#include <numbers>

namespace ostraka {
namespace {
using test::covered;
using test::differing_pixels;

RenderOptions bare(const std::string& size = "300x300") {
    RenderOptions options;
    options.size = size;
    options.view = "front";
    options.transparent = options.no_scale_bar = options.no_legend = true;
    return options;
}

TEST(Render, SilhouetteOfASphereIsADisc) {
    for (const char* view : {"front", "top", "iso", "17,-40"}) {
        RenderOptions options = bare();
        options.view = view;
        const Rendering rendering = render({test::sphere(64)}, options);
        const double radius = rendering.panes[0].pixels_per_unit;
        EXPECT_NEAR(covered(rendering.picture) / (std::numbers::pi * radius * radius), 1, 0.005) << view;
    }
}

TEST(Render, PerspectiveShowsTheTangentCone) {
    RenderOptions options = bare();
    options.projection = RenderOptions::Projection::perspective;
    const Rendering rendering = render({test::sphere(64)}, options);
    // The scale at the centre is f / d; the silhouette's radius is f / sqrt(d^2 - 1) for a unit sphere and fills the margin.
    const double scale = rendering.panes[0].pixels_per_unit, focal = 150 / std::tan(15 * std::numbers::pi / 180),
                 distance = focal / scale;
    const double radius = focal / std::sqrt(distance * distance - 1);
    EXPECT_NEAR(covered(rendering.picture) / (std::numbers::pi * radius * radius), 1, 0.01);
    EXPECT_NEAR(radius, 0.92 * 150, 1.5);
}

TEST(Render, MarkersAndLinesBehindTheSurfaceAreHidden) {
    Scene scene = test::sphere(48);
    const Rgb red{255, 0, 0}, green{0, 200, 0};
    scene.markers = {{{0, 1, 0}, red, 8, ""}};  // the front is towards -y
    RenderOptions options = bare();
    Rendering hidden = render({scene}, options);
    EXPECT_EQ(hidden.panes[0].markers_shown, 0U);
    EXPECT_EQ(hidden.picture.argb, render({test::sphere(48)}, options).picture.argb);

    scene.markers = {{{0, -1, 0}, red, 8, ""}};
    const Rendering seen = render({scene}, options);
    EXPECT_EQ(seen.panes[0].markers_shown, 1U);
    EXPECT_EQ(seen.picture.at(150, 150), 0xFFFF0000U);

    scene.markers.clear();
    SceneLine line;
    line.colour = green;
    line.width = 9;
    for (int i = -20; i <= 20; ++i) line.points.push_back({std::sin(i * 0.02), -std::cos(i * 0.02), 0});
    scene.lines = {line};
    EXPECT_EQ(render({scene}, options).picture.at(150, 150), 0xFF00C800U);
    for (auto& point : scene.lines[0].points) point[1] = -point[1];
    EXPECT_EQ(render({scene}, options).picture.argb, render({test::sphere(48)}, options).picture.argb);
}

TEST(Render, AFaceTowardsTheViewerHasItsOwnColour) {
    const Rgb blue{20, 90, 200}, orange{240, 150, 10};
    Scene scene = test::cube();
    scene.face_colours.assign(12, orange);
    scene.face_colours[test::front_of_cube] = scene.face_colours[test::front_of_cube + 1] = blue;
    const RenderOptions options = bare();
    EXPECT_EQ(render({scene}, options).picture.at(150, 150), 0xFF145AC8U);
    RenderOptions back = options;
    back.view = "back";
    EXPECT_EQ(render({scene}, back).picture.at(150, 150), 0xFFF0960AU);
}

TEST(Render, ValuesTakeTheColoursOfTheScale) {
    Scene scene = test::cube();
    scene.vertex_values.assign(8, 3);
    RenderOptions options = bare();
    options.scale = ColourScale{1, 4, false, ""};
    const Rgb wanted = colour_of(*options.scale, 3);
    const std::uint32_t pixel = 0xFF000000U | std::uint32_t{wanted.red} << 16 | std::uint32_t{wanted.green} << 8 | wanted.blue;
    EXPECT_EQ(render({scene}, options).picture.at(140, 160), pixel);
    scene.vertex_values.clear();
    scene.face_values.assign(12, 3);
    EXPECT_EQ(render({scene}, options).picture.at(140, 160), pixel);
}

TEST(Render, ViewsShowTheSidesTheyName) {
    // A cube with one colour a side, sides in the order front (-y), back, left (-x), right, bottom, top.
    Scene scene = test::cube();
    const char* const names[] = {"front", "back", "left", "right", "bottom", "top"};
    for (std::size_t i = 0; i < 12; ++i) scene.face_colours.push_back(category_colour(i / 2));
    RenderOptions options = bare();
    for (std::size_t side = 0; side < 6; ++side) {
        options.view = names[side];
        const Rgb c = category_colour(side);
        const std::uint32_t pixel = 0xFF000000U | std::uint32_t{c.red} << 16 | std::uint32_t{c.green} << 8 | c.blue;
        EXPECT_EQ(render({scene}, options).picture.at(150, 150), pixel) << names[side];
    }
    options.views = RenderOptions::Views::six;
    options.size = "300x200";
    EXPECT_EQ(render({scene}, options).panes.size(), 6U);
}

TEST(Render, ScaleBarIsAsLongAsItSays) {
    RenderOptions options;
    options.size = "800x600";
    options.view = "front";
    for (const double size : {1.0, 0.003, 7e8}) {
        const Scene scene = test::moved(test::cube(), size, {0, 0, 0});
        const Rendering rendering = render({scene}, options);
        const Pane& pane = rendering.panes[0];
        ASSERT_GT(pane.bar_length, 0);
        EXPECT_NEAR(round_length(pane.bar_length), pane.bar_length, 1e-9 * pane.bar_length);
        EXPECT_NEAR(pane.bar_pixels, pane.bar_length * pane.pixels_per_unit, 1e-6 * pane.bar_pixels);
        // The drawn bar: dark pixels of the row in its middle.
        const int row = pane.top + pane.height + 44 * 600 / 900 - 8 * 600 / 900 - 1;
        int dark = 0;
        for (int column = 0; column < 400; ++column) dark += (rendering.picture.at(column, row) & 0xFF) < 128;
        EXPECT_NEAR(dark, pane.bar_pixels, 1.5);
        // The cube's sides are 2 x size long.
        int wide = 0;
        for (int column = 0; column < 800; ++column) wide += rendering.picture.at(column, pane.height / 2) != 0xFFFFFFFFU;
        EXPECT_NEAR(wide, 2 * size * pane.pixels_per_unit, 1.5);
    }
}

TEST(Render, ObjectsAreSetSoThatTheyAreLargest) {
    RenderOptions options;
    options.view = "front";
    for (const auto& [size, rows] : {std::pair{"1600x300", 1}, {"1600x900", 2}, {"300x1600", 6}}) {
        options.size = size;
        const std::vector<Scene> scenes(6, test::cube());
        std::set<int> tops;
        for (const Pane& pane : render(scenes, options).panes) tops.insert(pane.top);
        EXPECT_EQ(tops.size(), static_cast<std::size_t>(rows)) << size;
    }
}

TEST(Render, NeitherPlaceNorSizeChangesThePicture) {
    const Scene scene = test::sphere(32);
    RenderOptions options = bare();
    options.view = "20,30";
    const Picture picture = render({scene}, options).picture;
    for (const double size : {1e-300, 1e-9, 1e9, 1e300}) {
        const Picture other = render({test::moved(scene, size, {0, 0, 0})}, options).picture;
        EXPECT_LT(differing_pixels(picture, other), 0.002 * static_cast<double>(picture.argb.size())) << size;
    }
    const Picture far = render({test::moved(scene, 1, {1e6, -3e6, 2e6})}, options).picture;
    EXPECT_LT(differing_pixels(picture, far), 0.002 * static_cast<double>(picture.argb.size()));
    EXPECT_NO_THROW(render({test::moved(scene, 1.7e308, {0, 0, 0})}, options));
}

TEST(Render, TheSameForAnyNumberOfThreads) {
    Scene scene = test::sphere(80);
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) scene.face_colours.push_back(category_colour(i % 7));
    Scene box = test::cube();  // rays that hit edges exactly
    for (std::size_t i = 0; i < 12; ++i) box.face_colours.push_back(category_colour(i));
    for (std::size_t i = 0; i < 12; ++i) box.mesh.triangles.push_back(box.mesh.triangles[i]);  // and triangles twice
    for (std::size_t i = 0; i < 12; ++i) box.face_colours.push_back(category_colour(i + 20));
    SceneLine line;
    for (int i = 0; i < 50; ++i) line.points.push_back({std::cos(i * 0.1), std::sin(i * 0.1), 0});
    scene.lines = {line};
    RenderOptions options;
    options.size = "401x300";
    options.edges = true;
    options.ambient_occlusion = 4;
    options.view = "front";
    set_threads(1);
    const Picture one = render({scene, box}, options).picture;
    for (const int threads : {2, 3, 7}) {
        set_threads(threads);
        EXPECT_EQ(one.argb, render({scene, box}, options).picture.argb);
    }
    set_threads(0);
}

TEST(Render, DegenerateObjects) {
    RenderOptions options = bare("120x90");
    Scene empty;
    EXPECT_EQ(covered(render({empty}, options).picture), 0);
    Scene points;
    points.mesh.points = {{1, 2, 3}, {1, 2, 3}};
    EXPECT_EQ(covered(render({points}, options).picture), 0);
    Scene triangle;
    triangle.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    triangle.mesh.triangles = {{0, 1, 2}};
    const Rendering seen = render({triangle}, options);
    const double scale = seen.panes[0].pixels_per_unit;
    EXPECT_NEAR(covered(seen.picture) / (scale * scale / 2), 1, 0.03);
    for (const char* view : {"left", "top", "iso"})  // the first two edge on
        for (const char* projection : {"orthographic", "perspective"}) {
            options.view = view;
            set_option(options, "projection", projection);
            EXPECT_NO_THROW(render({triangle}, options));
        }
    Scene collapsed = triangle;
    collapsed.mesh.triangles = {{0, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    EXPECT_NO_THROW(render({collapsed}, options));
    collapsed.mesh.points.assign(3, {5, 5, 5});
    EXPECT_NO_THROW(render({collapsed}, options));
    Scene repeated = test::cube();
    for (int i = 0; i < 12; ++i) repeated.mesh.triangles.push_back(repeated.mesh.triangles[static_cast<std::size_t>(i)]);
    EXPECT_GT(covered(render({repeated}, bare()).picture), 0);
}

TEST(Render, RefusesWhatCannotBeDrawn) {
    const auto kind = [](const Scene& scene, const RenderOptions& options) {
        try {
            (void)render({scene}, options);
        } catch (const Error& error) {
            return std::optional(error.kind());
        }
        return std::optional<ErrorKind>();
    };
    const RenderOptions good = bare();
    Scene scene = test::cube();
    scene.mesh.triangles[3][1] = 8;
    EXPECT_EQ(kind(scene, good), ErrorKind::input);
    scene = test::cube();
    scene.mesh.points[0][2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kind(scene, good), ErrorKind::input);
    scene = test::cube();
    scene.face_colours.resize(11);
    EXPECT_EQ(kind(scene, good), ErrorKind::input);
    scene = test::cube();
    scene.markers = {{{std::numeric_limits<double>::infinity(), 0, 0}, {}, 6, ""}};
    EXPECT_EQ(kind(scene, good), ErrorKind::input);
    scene = test::cube();
    const auto with = [&](auto&& change) {
        RenderOptions options = good;
        change(options);
        return kind(scene, options);
    };
    EXPECT_EQ(with([](auto& o) { o.view = "behind"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.view = "10,95"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.up = "w"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.up = "0,0,0"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.size = "10x10"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.size = "1200"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.size = "99999x99999"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.background = "beige"; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.zoom = -1; }), ErrorKind::usage);
    EXPECT_EQ(with([](auto& o) { o.zoom = std::numeric_limits<double>::quiet_NaN(); }), ErrorKind::usage);
}

TEST(Render, SeveralObjectsShareTheirScale) {
    const Scene small = test::moved(test::cube(), 0.5, {9, 9, 9}), large = test::cube();
    RenderOptions options = bare("600x300");
    Rendering rendering = render({small, large}, options);
    ASSERT_EQ(rendering.panes.size(), 2U);
    EXPECT_DOUBLE_EQ(rendering.panes[0].pixels_per_unit, rendering.panes[1].pixels_per_unit);
    options.fit = RenderOptions::Fit::each;
    rendering = render({small, large}, options);
    EXPECT_NEAR(rendering.panes[0].pixels_per_unit, 2 * rendering.panes[1].pixels_per_unit, 1e-6);
    options.fit = RenderOptions::Fit::all;
    options.projection = RenderOptions::Projection::perspective;
    rendering = render({small, large}, options);
    EXPECT_NEAR(rendering.panes[0].pixels_per_unit, rendering.panes[1].pixels_per_unit, 1e-9);
}

TEST(Render, LegendsOfAnyTextAreDrawn) {
    Scene scene = test::cube();
    scene.title = std::string("t\0i\x1b[31mtle", 11);
    scene.legend = {
        {"κύλιξ", {200, 0, 0}}, {std::string(100000, 'x'), {0, 0, 200}}, {"\xFF\xFE bad", {0, 200, 0}}, {"", {1, 2, 3}}};
    for (int i = 0; i < 300; ++i)
        scene.legend.push_back({"entry " + std::to_string(i), category_colour(static_cast<std::size_t>(i))});
    RenderOptions options;
    options.size = "640x480";
    const Rendering rendering = render({scene}, options);
    EXPECT_LE(rendering.panes[0].width, 640);
    EXPECT_GE(rendering.panes[0].width, 400);
    options.size = "16x16";
    EXPECT_NO_THROW(render({scene}, options));
}
}  // namespace
}  // namespace ostraka
