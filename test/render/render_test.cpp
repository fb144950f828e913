#include "ostraka/render/render.h"

#include "ostraka/execution/parallel.h"
#include "read_png.h"
#include "scenes.h"
#include "scratch.h"

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
    const Rendering visible = render({scene}, options);
    EXPECT_EQ(visible.panes[0].markers_shown, 1U);
    EXPECT_EQ(visible.picture.at(150, 150), 0xFFFF0000U);

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
    RenderOptions from_behind = options;
    from_behind.view = "back";
    EXPECT_EQ(render({scene}, from_behind).picture.at(150, 150), 0xFFF0960AU);
}

TEST(Render, ValuesTakeTheColoursOfTheScale) {
    Scene scene = test::cube();
    scene.vertex_values.assign(8, 3);
    RenderOptions options = bare();
    options.scale = ColourScale{1, 4, false, ""};
    const Rgb expected = colour_of(*options.scale, 3);
    const std::uint32_t pixel =
        0xFF000000U | std::uint32_t{expected.red} << 16 | std::uint32_t{expected.green} << 8 | expected.blue;
    EXPECT_EQ(render({scene}, options).picture.at(140, 160), pixel);
    scene.vertex_values.clear();
    scene.face_values.assign(12, 3);
    EXPECT_EQ(render({scene}, options).picture.at(140, 160), pixel);
}

TEST(Render, ViewsShowTheSidesTheyName) {
    // A cube with one colour per side, sides in the order front (-y), back, left (-x), right, bottom, top.
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
    options.views = "six";
    options.size = "300x200";
    EXPECT_EQ(render({scene}, options).panes.size(), 6U);
}

TEST(Render, ScaleBarHasTheStatedLength) {
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
        int width = 0;
        for (int column = 0; column < 800; ++column) width += rendering.picture.at(column, pane.height / 2) != 0xFFFFFFFFU;
        EXPECT_NEAR(width, 2 * size * pane.pixels_per_unit, 1.5);
    }
}

TEST(Render, ObjectsAreArrangedToBeLargest) {
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

TEST(Render, PicturesAreInvariantToPositionAndScale) {
    const Scene scene = test::sphere(32);
    RenderOptions options = bare();
    options.view = "20,30";
    const Picture picture = render({scene}, options).picture;
    for (const double size : {1e-300, 1e-9, 1e9, 1e300}) {
        const Picture scaled = render({test::moved(scene, size, {0, 0, 0})}, options).picture;
        EXPECT_LT(differing_pixels(picture, scaled), 0.002 * static_cast<double>(picture.argb.size())) << size;
    }
    const Picture distant = render({test::moved(scene, 1, {1e6, -3e6, 2e6})}, options).picture;
    EXPECT_LT(differing_pixels(picture, distant), 0.002 * static_cast<double>(picture.argb.size()));
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
    const Picture sequential = render({scene, box}, options).picture;
    for (const int threads : {2, 3, 7}) {
        set_threads(threads);
        EXPECT_EQ(sequential.argb, render({scene, box}, options).picture.argb);
    }
    set_threads(0);
}

TEST(Render, DegenerateObjects) {
    RenderOptions options = bare("120x90");
    Scene empty_scene;
    EXPECT_EQ(covered(render({empty_scene}, options).picture), 0);
    Scene points;
    points.mesh.points = {{1, 2, 3}, {1, 2, 3}};
    EXPECT_EQ(covered(render({points}, options).picture), 0);
    Scene triangle;
    triangle.mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    triangle.mesh.triangles = {{0, 1, 2}};
    const Rendering rendering = render({triangle}, options);
    const double scale = rendering.panes[0].pixels_per_unit;
    EXPECT_NEAR(covered(rendering.picture) / (scale * scale / 2), 1, 0.03);
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

TEST(Render, RejectsInvalidScenesAndOptions) {
    const auto kind = [](const Scene& scene, const RenderOptions& options) {
        try {
            (void)render({scene}, options);
        } catch (const Error& error) {
            return std::optional(error.kind());
        }
        return std::optional<ErrorKind>();
    };
    const RenderOptions valid = bare();
    Scene scene = test::cube();
    scene.mesh.triangles[3][1] = 8;
    EXPECT_EQ(kind(scene, valid), ErrorKind::input);
    scene = test::cube();
    scene.mesh.points[0][2] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kind(scene, valid), ErrorKind::input);
    scene = test::cube();
    scene.face_colours.resize(11);
    EXPECT_EQ(kind(scene, valid), ErrorKind::input);
    scene = test::cube();
    scene.markers = {{{std::numeric_limits<double>::infinity(), 0, 0}, {}, 6, ""}};
    EXPECT_EQ(kind(scene, valid), ErrorKind::input);
    scene = test::cube();
    const auto kind_with = [&](auto&& change) {
        RenderOptions options = valid;
        change(options);
        return kind(scene, options);
    };
    EXPECT_EQ(kind_with([](auto& o) { o.view = "behind"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.view = "10,95"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.up = "w"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.up = "0,0,0"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.size = "10x10"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.size = "1200"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.size = "99999x99999"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.background = "beige"; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.zoom = -1; }), ErrorKind::usage);
    EXPECT_EQ(kind_with([](auto& o) { o.zoom = std::numeric_limits<double>::quiet_NaN(); }), ErrorKind::usage);
}

TEST(Render, ContoursOfASphereAreItsCircle) {
    RenderOptions options = bare();
    options.drawing = RenderOptions::Drawing::lines;
    const Rendering rendering = render({test::sphere(40)}, options);
    const double radius = rendering.panes[0].pixels_per_unit;
    std::set<int> turns;
    for (int y = 0; y < 300; ++y)
        for (int x = 0; x < 300; ++x) {
            if (rendering.picture.at(x, y) >> 24 < 128) continue;
            const double dx = x + 0.5 - 150, dy = y + 0.5 - 150;
            EXPECT_NEAR(std::hypot(dx, dy), radius, 0.02 * radius + 1.5);
            turns.insert(static_cast<int>((std::atan2(dy, dx) + std::numbers::pi) * 36 / (2 * std::numbers::pi)));
        }
    EXPECT_GE(turns.size(), 36U);
}

TEST(Render, HiddenEdgesOfACubeAreNotDrawn) {
    RenderOptions options = bare("600x600");
    options.view = "iso";
    options.drawing = RenderOptions::Drawing::lines;
    const Rendering rendering = render({test::cube()}, options);
    const PictureCamera& camera = rendering.panes[0].camera;
    const auto drawn = [&](const Point& point) {
        const auto place = camera.project(point);
        for (int dy = -2; dy <= 2; ++dy)
            for (int dx = -2; dx <= 2; ++dx)
                if (rendering.picture.at(static_cast<int>((*place)[0]) + dx, static_cast<int>((*place)[1]) + dy) >> 24 > 100)
                    return true;
        return false;
    };
    // The viewer stands in front (-y), at the right (+x), above (+z): the three edges at the far corner are hidden.
    std::size_t drawn_count = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double a : {-1.0, 1.0})
            for (const double b : {-1.0, 1.0}) {
                const Point point = axis == 0 ? Point(0.3, a, b) : axis == 1 ? Point(a, 0.3, b) : Point(a, b, 0.3);
                const bool hidden = axis == 0 ? a > 0 && b < 0 : axis == 1 ? a < 0 && b < 0 : a < 0 && b > 0;
                EXPECT_EQ(drawn(point), !hidden) << axis << " " << a << " " << b;
                drawn_count += drawn(point);
            }
    EXPECT_EQ(drawn_count, 9U);
    // The diagonal across the front is not drawn as a line of a drawing, but as an edge of a wire frame.
    const auto middle = *camera.project(Point(0, -1, 0));
    const auto column = static_cast<int>(middle[0]), row = static_cast<int>(middle[1]);
    EXPECT_EQ(rendering.picture.at(column, row) >> 24, 0U);
    options.drawing = RenderOptions::Drawing::wire;
    EXPECT_GT(render({test::cube()}, options).picture.at(column, row) >> 24, 0U);
    options.drawing = RenderOptions::Drawing::points;
    EXPECT_GT(covered(render({test::cube()}, options).picture), 0);
}

TEST(Render, LabelsDoNotOverlapOrCrossAndPointToTheirParts) {
    Scene scene = test::sphere(40);
    for (int part = 0; part < 23; ++part) {
        SceneLabel& label = scene.labels.emplace_back();
        label.text = "part number " + std::to_string(part);
        const std::size_t n = scene.mesh.triangles.size();
        for (std::size_t t = n * static_cast<std::size_t>(part) / 23; t < n * static_cast<std::size_t>(part + 1) / 23; ++t)
            label.faces.push_back(static_cast<Index>(t));
    }
    scene.labels.push_back({"a point in front", {}, {}, {{0, -1, 0}}});
    scene.labels.push_back({"a point behind", {}, {}, {{0, 1, 0}}});
    for (const char* size : {"900x700", "500x300"}) {
        RenderOptions options;
        options.size = size;
        options.view = "front";
        options.labels = true;
        const Rendering rendering = render({scene}, options);
        const Pane& pane = rendering.panes[0];
        ASSERT_GT(pane.labels.size(), 10U);
        const auto has_label = [&](const std::string& start) {
            return std::any_of(pane.labels.begin(), pane.labels.end(), [&](const auto& l) { return l.text.starts_with(start); });
        };
        if (std::string(size) == "900x700") {
            EXPECT_TRUE(has_label("a point in front"));
        }
        EXPECT_FALSE(has_label("a point behind"));
        const auto side = [](double ax, double ay, double bx, double by, double cx, double cy) {
            return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        };
        for (const PaneLabel& a : pane.labels) {
            EXPECT_GE(a.left, 0);
            EXPECT_GE(a.top, pane.top - 1e-9);
            EXPECT_LE(a.top + a.height, pane.top + pane.height + 1e-9);
            const bool a_left = a.left < a.place_x;
            EXPECT_TRUE(a_left ? a.left + a.width < pane.left : a.left > pane.left + pane.width) << "beside the object";
            for (const PaneLabel& b : pane.labels) {
                if (&a == &b || (b.left < b.place_x) != a_left) continue;
                EXPECT_TRUE(a.top + a.height <= b.top + 1e-6 || b.top + b.height <= a.top + 1e-6) << a.text << ", " << b.text;
                const double edge = a_left ? pane.left - 5 : pane.left + pane.width + 5;
                const double ay = a.top + a.height / 2, by = b.top + b.height / 2;
                const bool crossing =
                    side(edge, ay, a.place_x, a.place_y, edge, by) * side(edge, ay, a.place_x, a.place_y, b.place_x, b.place_y) <
                        0 &&
                    side(edge, by, b.place_x, b.place_y, edge, ay) * side(edge, by, b.place_x, b.place_y, a.place_x, a.place_y) <
                        0;
                EXPECT_FALSE(crossing) << a.text << ", " << b.text;
            }
        }
        // The line of a region ends on it: the ray through its end hits one of its triangles.
        for (const PaneLabel& label : pane.labels) {
            if (!label.text.starts_with("part number ") || label.text.ends_with("\xE2\x80\xA6")) continue;
            const std::size_t index = static_cast<std::size_t>(std::stoi(label.text.substr(12)));
            const PictureCamera::Ray ray = pane.camera.ray(label.place_x, label.place_y);
            const double x = ray.origin.x(), z = ray.origin.z();
            const Point point(x, -std::sqrt(std::max(0.0, 1 - x * x - z * z)), z);
            double nearest = 1e9;
            for (const Index t : scene.labels[index].faces)
                for (const Index v : scene.mesh.triangles[t]) {
                    const auto& p = scene.mesh.points[v];
                    nearest = std::min(nearest, std::sqrt(CGAL::squared_distance(point, Point(p[0], p[1], p[2]))));
                }
            EXPECT_LT(nearest, 0.1) << label.text;
        }
    }
}

TEST(Render, DocumentsAreTheSameBytesInOneProcess) {
    Scene scene = test::cube();
    scene.labels.push_back({"front", {200, 0, 0}, {test::front_of_cube}, {}});
    RenderOptions options = bare();
    options.labels = options.axes = options.contours = true;
    for (const PictureKind kind : {PictureKind::svg, PictureKind::pdf}) {
        const std::string document = render({scene}, options, kind).document;
        EXPECT_TRUE(document.starts_with(kind == PictureKind::svg ? "<?xml" : "%PDF-"));
        EXPECT_EQ(document, render({scene}, options, kind).document);
        EXPECT_EQ(document.find("CreationDate"), std::string::npos);
    }
    options.drawing = RenderOptions::Drawing::lines;
    EXPECT_EQ(render({scene}, options, PictureKind::svg).document.find("<image"), std::string::npos) << "nothing but lines";
}

TEST(Render, DeepAndFinerPicturesShowTheSame) {
    Scene scene = test::sphere(60);
    scene.lines.push_back({{{-1, -1, 1}, {1, -1, 1}}, {0, 200, 0}, 5, true, true});
    RenderOptions options;
    options.size = "200x150";
    const Picture standard = render({scene}, options).picture;
    options.sixteen_bit = true;
    const DeepPicture deep = render({scene}, options).deep;
    ASSERT_EQ(deep.rgba.size(), standard.argb.size());
    std::set<int> levels;
    for (std::size_t i = 0; i < deep.rgba.size(); ++i)
        for (unsigned k = 0; k < 3; ++k) {
            EXPECT_NEAR(deep.rgba[i][k] / 257.0, standard.argb[i] >> (16 - 8 * k) & 255U, 2.1);
            levels.insert(deep.rgba[i][0]);
        }
    EXPECT_GT(levels.size(), 300U) << "more than 8 bits can hold";
    options.sixteen_bit = false;
    options.supersample = 3;
    double difference = 0;
    const Picture fine = render({scene}, options).picture;
    for (std::size_t i = 0; i < fine.argb.size(); ++i)
        difference += std::abs(static_cast<double>(fine.argb[i] & 255U) - static_cast<double>(standard.argb[i] & 255U));
    EXPECT_LT(difference / static_cast<double>(fine.argb.size()), 1.0);
    const test::Scratch scratch;
    write_png(scratch / "deep.png", deep);
    const Picture reread = test::read_png(scratch / "deep.png");
    for (std::size_t i = 0; i < reread.argb.size(); ++i) EXPECT_NEAR(reread.argb[i] & 255U, standard.argb[i] & 255U, 3.1);
}

TEST(Render, PatchesColourWhereTheirWeightIsLargest) {
    Scene scene;
    scene.mesh.points = {{0, 0, 0}, {2, 0, 0}, {0, 0, 2}};
    scene.mesh.triangles = {{0, 1, 2}};
    const Rgb red{200, 0, 0}, blue{0, 0, 200};
    scene.patches = {{0, red, {1, 0, 0}}, {0, blue, {0, 1, 1}}};  // equal half way from the first corner
    const Rendering rendering = render({scene}, bare());
    const auto colour_at = [&](double x, double z) {
        const auto place = *rendering.panes[0].camera.project(Point(x, 0, z));
        return rendering.picture.at(static_cast<int>(place[0]), static_cast<int>(place[1]));
    };
    EXPECT_EQ(colour_at(0.4, 0.4), 0xFFC80000U);
    EXPECT_EQ(colour_at(0.6, 0.6), 0xFF0000C8U);
}

TEST(Render, SeveralObjectsShareTheirScale) {
    const Scene half_size = test::moved(test::cube(), 0.5, {9, 9, 9}), full_size = test::cube();
    RenderOptions options = bare("600x300");
    Rendering rendering = render({half_size, full_size}, options);
    ASSERT_EQ(rendering.panes.size(), 2U);
    EXPECT_DOUBLE_EQ(rendering.panes[0].pixels_per_unit, rendering.panes[1].pixels_per_unit);
    options.fit = RenderOptions::Fit::each;
    rendering = render({half_size, full_size}, options);
    EXPECT_NEAR(rendering.panes[0].pixels_per_unit, 2 * rendering.panes[1].pixels_per_unit, 1e-6);
    options.fit = RenderOptions::Fit::all;
    options.projection = RenderOptions::Projection::perspective;
    rendering = render({half_size, full_size}, options);
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
