#include "ostraka/measure/surface_colour.h"
#include "ostraka/measure/appearance_change.h"

#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// A flat square of side 2 with an image whose left half is red and whose right half is blue.
MeshFile flag() {
    MeshFile file{build_mesh(test::grid(20, 20, false, false,
                                        [](double u, double v) {
                                            return std::array<double, 3>{2 * u, 2 * v, 0};
                                        })),
                  {},
                  {},
                  {}};
    Pixels pixels{64, 64, {}};
    for (int row = 0; row < 64; ++row)
        for (int column = 0; column < 64; ++column)
            pixels.rgba.push_back(column < 32 ? std::array<std::uint8_t, 4>{255, 0, 0, 255}
                                              : std::array<std::uint8_t, 4>{0, 0, 255, 255});
    file.extras.appearance.images.push_back(std::make_shared<const Image>(encode(pixels, ImageFormat::png, "flag.png")));
    file.extras.appearance.materials.resize(1);
    file.extras.appearance.materials[0].image = 0;
    file.extras.appearance.materials[0].wrap_u = file.extras.appearance.materials[0].wrap_v = TextureWrap::clamp;
    for (const Face face : file.mesh.faces()) {
        file.extras.face_materials.push_back(0);
        for (const Vertex v : corners(file.mesh, face))
            file.extras.corner_texture.push_back({float(file.mesh.point(v).x() / 2), float(file.mesh.point(v).y() / 2)});
    }
    return file;
}

Annotation faces_left_of(const Mesh& mesh, double x) {
    Annotation region;
    region.type = AnnotationType::region;
    region.tag = "part";
    for (const Face face : mesh.faces())
        if (centroid(mesh, face).x() < x) region.faces.push_back(face);
    return region;
}

TEST(SurfaceColour, VerticesHaveTheColourOfTheImageAroundThem) {
    const MeshFile file = flag();
    const std::vector<Lab> colours = vertex_lab(file.mesh, file.extras, "flag");
    const Lab red = lab_from_linear({1, 0, 0}), blue = lab_from_linear({0, 0, 1});
    for (const Vertex v : file.mesh.vertices()) {
        const double x = file.mesh.point(v).x();
        if (x > 0.85 && x < 1.15) continue;
        EXPECT_LT(colour_difference(colours[v], x < 1 ? red : blue), 1) << x;
    }
}

TEST(AppearanceChange, IsTheShareOfTheSurfaceThatShowsAnotherColour) {
    const MeshFile before = flag();
    const AppearanceChange none = appearance_change(before, before.mesh, before.extras, "flag");
    EXPECT_EQ(none.mean, 0);
    EXPECT_GT(none.resampling, 0);
    EXPECT_LT(none.resampling, 10);
    MeshExtras shifted = before.extras;
    for (TexturePoint& point : shifted.corner_texture) point[0] += 0.25F;
    const AppearanceChange change = appearance_change(before, before.mesh, shifted, "flag", 5000);
    EXPECT_EQ(change.samples, 5000U);
    // A quarter of the surface is blue instead of red: 255 in two of three channels.
    EXPECT_NEAR(change.mean, 0.25 * 170, 1.5);
}

TEST(SurfaceColour, MeasuresOfAPart) {
    const MeshFile file = flag();
    const AnnotationSet none;
    const auto measure = [&](double x) {
        return measure_colour({file.mesh, none}, faces_left_of(file.mesh, x), file.extras, "flag");
    };
    const Lab red = lab_from_linear({1, 0, 0}), blue = lab_from_linear({0, 0, 1});
    const ColourMeasures left = measure(0.8);
    EXPECT_LT(colour_difference(left.mean, red), 0.5);
    EXPECT_LT(left.spread, 1);
    EXPECT_GE(left.mean_rgb[0], 254);
    const ColourMeasures all = measure(3);
    double distance = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(all.mean[k], (red[k] + blue[k]) / 2, 2);
        distance += (red[k] - blue[k]) * (red[k] - blue[k]) / 4;
    }
    EXPECT_NEAR(all.spread, std::sqrt(distance), 0.05 * all.spread);
    EXPECT_NEAR(all.lightness_low, blue[0], 1);
    EXPECT_NEAR(all.lightness_high, red[0], 1);
}

TEST(SurfaceColour, OwnColoursMultiplyTheImage) {
    MeshFile file = flag();
    EXPECT_TRUE(has_colours(file.extras));
    file.extras.vertex_colours.assign(file.mesh.number_of_vertices(), Colour{0, 255, 255, 255});
    const SurfaceColour surface(file.mesh, file.extras, "flag");
    const auto colour = surface.at(Face(0), {1.0 / 3, 1.0 / 3, 1.0 / 3});  // red times cyan
    for (const float channel : colour) EXPECT_NEAR(channel, 0, 1e-6);
    EXPECT_FALSE(has_colours(MeshExtras()));
}

TEST(SurfaceColour, PartsWithoutAreaAreRefused) {
    const MeshFile file = flag();
    const AnnotationSet none;
    Annotation line;
    line.type = AnnotationType::line;
    EXPECT_THROW(measure_colour({file.mesh, none}, line, file.extras, "flag"), Error);
    EXPECT_THROW(measure_colour({file.mesh, none}, faces_left_of(file.mesh, -1), file.extras, "flag"), Error);
}

}  // namespace
}  // namespace ostraka
