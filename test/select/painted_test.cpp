// Figures and edges in the image of a surface.
#include "meshes.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/surface_point.h"
#include "ostraka/select/colour_edges.h"
#include "ostraka/select/recipe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ostraka {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int size_of_image = 256;

/// A surface over the unit square with an image; `shape(u, v)`: position, `colour(u, v)`: colour.
MeshFile with_image(int cells, const std::function<std::array<double, 3>(double, double)>& shape,
                    const std::function<std::array<std::uint8_t, 4>(double, double)>& colour) {
    MeshFile file{build_mesh(test::grid(cells, cells, false, false, shape)), {}, {}, {}};
    std::vector<TexturePoint> at;
    test::grid(cells, cells, false, false, [&](double u, double v) {
        at.push_back({static_cast<float>(u), static_cast<float>(v)});
        return std::array<double, 3>{u, v, 0};
    });
    Pixels pixels{size_of_image, size_of_image, {}};
    for (int row = 0; row < size_of_image; ++row)
        for (int column = 0; column < size_of_image; ++column)
            pixels.rgba.push_back(colour((column + 0.5) / size_of_image, 1 - (row + 0.5) / size_of_image));
    file.extras.appearance.images.push_back(std::make_shared<const Image>(encode(pixels, ImageFormat::png, "image.png")));
    file.extras.appearance.materials.resize(1);
    file.extras.appearance.materials[0].image = 0;
    file.extras.appearance.materials[0].wrap_u = file.extras.appearance.materials[0].wrap_v = TextureWrap::clamp;
    for (const Face face : file.mesh.faces()) {
        file.extras.face_materials.push_back(0);
        for (const Vertex v : corners(file.mesh, face)) file.extras.corner_texture.push_back(at[v]);
    }
    return file;
}

std::array<double, 3> flat(double u, double v) { return {u, v, 0}; }

/// Light ground with two dark discs of radius 0.2 and 0.1, and specks of one texel.
std::array<std::uint8_t, 4> discs(double u, double v) {
    const bool speck = int(u * size_of_image) % 32 == 3 && int(v * size_of_image) % 32 == 3;
    const bool dark = std::hypot(u - 0.35, v - 0.4) < 0.2 || std::hypot(u - 0.8, v - 0.8) < 0.1;
    return dark != speck ? std::array<std::uint8_t, 4>{70, 25, 15, 255} : std::array<std::uint8_t, 4>{205, 150, 105, 255};
}

Annotation select(const MeshFile& file, const std::string& painted, const std::string& outline = "") {
    const Json recipe = parse_json(R"({"format": "ostraka-recipe", "version": 1, "annotations": [
        {"id": 1, "tag": "figure", "type": "region", )" +
                                       outline + R"("select": {"painted": )" + painted + "}}]}",
                                   "recipe");
    RecipeStart start;
    start.attributes = &file.extras;
    AnnotationSet set = follow_recipe(recipe, file.mesh, std::move(start), "recipe");
    EXPECT_TRUE(set.notes.empty()) << set.notes.front();
    return set.annotations.back();
}

TEST(Painted, AFigureIsSelectedInsideTheTrianglesOfACoarseMesh) {
    const MeshFile file = with_image(2, flat, discs);
    const Annotation all = select(file, R"({"like": "#46190f"})");
    EXPECT_NEAR(area_of(file.mesh, all), pi * (0.04 + 0.01), 0.02 * pi * 0.05);
    EXPECT_EQ(all.curves.size(), 2U);
    const Annotation one = select(file, R"({"at": [[0.35, 0.4, 0]]})");
    EXPECT_NEAR(area_of(file.mesh, one), pi * 0.04, 0.02 * pi * 0.04);
    EXPECT_NEAR(measure_region(file.mesh, one).perimeter, 2 * pi * 0.2, 0.03 * 2 * pi * 0.2);
    for (const auto& curve : one.curves)
        for (const Point& p : positions(file.mesh, curve))
            EXPECT_NEAR(std::hypot(p.x() - 0.35, p.y() - 0.4), 0.2, 1.5 / size_of_image);
    const Annotation by_edge = select(file, R"({"at": [[0.8, 0.8, 0]], "edge": true})");
    EXPECT_NEAR(area_of(file.mesh, by_edge), pi * 0.01, 0.04 * pi * 0.01);
}

TEST(Painted, BoundsOfLightness) {
    const MeshFile file = with_image(6, flat, discs);
    const Annotation dark = select(file, R"({"lightness": [0, 40]})");
    EXPECT_NEAR(area_of(file.mesh, dark), pi * 0.05, 0.02 * pi * 0.05);
    const Annotation none = select(file, R"({"lightness": [0, 40], "hue": [0, 180], "smallest": 0.2})");
    EXPECT_NEAR(area_of(file.mesh, none), pi * 0.04, 0.02 * pi * 0.04);  // the smaller disc is left out
}

TEST(Painted, OutlineAlongEdgesAndTheSameFarFromTheOrigin) {
    const MeshFile file = with_image(30, flat, discs);
    const Annotation edges = select(file, R"({"at": [[0.35, 0.4, 0]]})", R"("outline": "edges", )");
    EXPECT_FALSE(is_free(edges));
    EXPECT_NEAR(area_of(file.mesh, edges), pi * 0.04, 0.06 * pi * 0.04);
    const MeshFile far = with_image(
        4,
        [](double u, double v) {
            return std::array<double, 3>{5e5 + 1e-3 * u, 5e6 + 1e-3 * v, 0};
        },
        discs);
    EXPECT_NEAR(area_of(far.mesh, select(far, R"({"like": "#46190f"})")), 1e-6 * pi * 0.05, 0.02e-6 * pi * 0.05);
}

TEST(Painted, RefusesWhatItCannotFind) {
    const MeshFile file = with_image(2, flat, discs);
    EXPECT_THROW(select(file, R"({"like": "#00ff00", "at": [[0.35, 0.4, 0]], "tolerance": 3})"), Error);
    EXPECT_THROW(select(file, R"({"tolerance": 3})"), Error);
    EXPECT_THROW(select(file, R"({"edge": true, "like": "#00ff00"})"), Error);
    MeshFile bare = file;
    bare.extras = {};
    EXPECT_THROW(select(bare, R"({"like": "#46190f"})"), Error);
}

TEST(ColourEdges, ACircleOnASphereHasItsRadius) {
    const double radius = 0.5;  // angle
    const auto sphere = [](double u, double v) {
        const double longitude = 2 * u - 1, latitude = 2 * v - 1;
        return std::array<double, 3>{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                                     std::sin(latitude)};
    };
    const MeshFile file = with_image(60, sphere, [&](double u, double v) {
        return std::acos(sphere(u, v)[0]) < radius ? std::array<std::uint8_t, 4>{160, 40, 30, 255}
                                                   : std::array<std::uint8_t, 4>{210, 170, 120, 255};
    });
    const auto edges = find_colour_edges(file.mesh, file.extras, {}, "sphere");
    ASSERT_FALSE(edges.empty());
    double length = 0;  // a line may be found in several pieces
    for (const auto& edge : edges) length += edge.length;
    EXPECT_NEAR(length, 2 * pi * std::sin(radius), 0.02 * 2 * pi * std::sin(radius));
    for (const Point& p : positions(file.mesh, edges[0].line))
        EXPECT_NEAR(std::acos(p.x() / std::sqrt((p - CGAL::ORIGIN).squared_length())), radius, 2.0 / size_of_image);
    const AnnotationSet set = annotate_colour_edges(file.mesh, edges, "mm");
    EXPECT_TRUE(is_free(set.annotations.at(0)));
    EXPECT_NEAR(length_of(file.mesh, set.annotations[0]), edges[0].length, 1e-9);
}

TEST(ColourEdges, NoneOnOneColourAndErrors) {
    const MeshFile file = with_image(4, flat, [](double, double) { return std::array<std::uint8_t, 4>{90, 90, 90, 255}; });
    EXPECT_TRUE(find_colour_edges(file.mesh, file.extras, {}, "grey").empty());
    EXPECT_THROW(find_colour_edges(file.mesh, {}, {}, "bare"), Error);
    ColourEdgeOptions options;
    options.min_contrast = 20;
    EXPECT_THROW(find_colour_edges(file.mesh, file.extras, options, "grey"), Error);
}

}  // namespace
}  // namespace ostraka
