#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/remesh/remesh.h"
#include "texture/fill.h"
#include "texture/textured.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Mesh remeshed(const Mesh& mesh, std::uint64_t vertices) {
    RemeshOptions options;
    options.vertices = vertices;
    options.feature_angle = 45;
    return remesh(mesh, options).mesh;
}

/// A sphere whose vertices have the colours of a function.
MeshFile coloured_sphere(int levels, const ColourFunction& colour) {
    MeshFile file;
    file.mesh = build_mesh(octahedron_sphere(levels));
    for (const Vertex v : file.mesh.vertices()) file.extras.vertex_colours.push_back(rounded(colour(file.mesh.point(v))));
    return file;
}

}  // namespace

TEST(Bake, ATexturedCubeOnARemeshedCopy) {
    const MeshFile source = textured_box(6, 96, waves);
    const Mesh target = remeshed(source.mesh, 400);
    const BakedMesh result = baked(target, source, texel_size(source));
    EXPECT_LT(mean_error(target, result.extras, waves), 3);
    EXPECT_EQ(result.result.counts.without, 0U);
    EXPECT_GT(result.result.counts.by_ray, result.result.counts.total() * 9 / 10);
    EXPECT_LT(result.result.counts.largest_distance, 0.02 * box_diagonal(target));
    EXPECT_EQ(result.result.samples, 1);
    EXPECT_EQ(result.extras.appearance.images[0]->name, "baked.png");
}

TEST(Bake, FarFromTheOrigin) {
    const double scale = 100;
    const std::array<double, 3> by{4e5, 5e6, 300};
    const MeshFile source = textured_box(6, 64, waves, scale, by);
    const Mesh target = build_mesh(moved(box(5), scale, by));
    const BakedMesh result = baked(target, source, texel_size(source));
    const auto colour = [&](const Point& p) {
        return waves(Point((p.x() - by[0]) / scale, (p.y() - by[1]) / scale, (p.z() - by[2]) / scale));
    };
    EXPECT_LT(mean_error(target, result.extras, colour), 3);
}

TEST(Bake, LargeTexelsShowTheMeanOfTheSource) {
    // Stripes of one texel, black and white: the mean in linear light is 0.5, which is 188 as sRGB.
    const auto stripes = [](const Point& p) {
        const double c = static_cast<int>(std::floor(p.x() * 128)) % 2 != 0 ? 255 : 0;
        return std::array<double, 3>{c, c, c};
    };
    MeshFile source = textured_box(2, 128, stripes);
    source.extras.appearance.materials[0].nearest = true;
    const BakedMesh result = baked(build_mesh(box(3)), source, 4 * texel_size(source));
    EXPECT_EQ(result.result.samples, 4);
    const auto mean = [](const Point&) { return std::array<double, 3>{188, 188, 188}; };
    // The sides perpendicular to the stripes' direction are of one colour; they are a third.
    EXPECT_LT(mean_error(build_mesh(box(3)), result.extras, mean), 0.4 * 188 + 12);
}

TEST(Bake, ColoursOfVerticesOnASphereAndBack) {
    const MeshFile source = coloured_sphere(6, waves);
    const Mesh target = remeshed(source.mesh, 1500);
    const BakedMesh result = baked(target, source, 0.01);
    EXPECT_LT(mean_error(target, result.extras, waves), 3);
    MeshFile textured;
    textured.mesh = target;
    textured.extras = result.extras;
    const BakedVertices back = bake_vertices(source.mesh, textured, {}, "sphere");
    ASSERT_EQ(back.colours.size(), source.mesh.number_of_vertices());
    EXPECT_EQ(back.counts.without, 0U);
    double sum = 0;
    for (std::size_t v = 0; v < back.colours.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k)
            sum += std::abs(back.colours[v][k] - static_cast<double>(source.extras.vertex_colours[v][k]));
    EXPECT_LT(sum / (3.0 * static_cast<double>(back.colours.size())), 3);
}

TEST(Bake, VertexColoursAreMeansOfTheirSharesNotPoints) {
    // A chequered image whose squares are much smaller than the faces: every vertex is grey.
    const auto squares = [](const Point& p) {
        const long sum = std::lround(std::floor(p.x() * 32 + 0.01)) + std::lround(std::floor(p.y() * 32 + 0.01)) +
                         std::lround(std::floor(p.z() * 32 + 0.01));
        const double c = sum % 2 != 0 ? 255 : 0;
        return std::array<double, 3>{c, c, c};
    };
    const MeshFile source = textured_box(4, 128, squares);
    const BakedVertices result = bake_vertices(build_mesh(box(4)), source, {}, "box");
    for (const Colour& colour : result.colours) EXPECT_NEAR(colour[0], 188, 25);
}

TEST(Bake, ColoursOfFacesAndMaterialsWithoutImages) {
    MeshFile source;
    source.mesh = build_mesh(box(2));
    Material red;
    red.base_colour = {1, 0.25F, 0, 1};
    source.extras.appearance.materials = {red};
    source.extras.face_materials.assign(source.mesh.number_of_faces(), 0);
    for (const Face f : source.mesh.faces())
        source.extras.face_colours.push_back(centroid(source.mesh, f).z() > 0.4 ? Colour{255, 255, 255, 255} : Colour{0, 0, 0, 255});
    const BakedMesh result = baked(source.mesh, source, 0.05);
    const TextureSampler sampler(result.extras.appearance, "box");
    for (const Face f : source.mesh.faces()) {
        TexturePoint middle{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 2; ++axis)
                middle[axis] += result.extras.corner_texture[3 * static_cast<std::size_t>(f) + k][axis] / 3;
        const auto light = sampler.colour(0, middle);
        const bool white = source.extras.face_colours[f][0] == 255;
        EXPECT_NEAR(light[0], white ? 1 : 0, 0.02) << f;
        EXPECT_NEAR(light[1], white ? 0.25 : 0, 0.02) << f;
    }
}

TEST(Bake, ReliefIsTheHeightAlongTheNormal) {
    MeshFile source;
    source.mesh = build_mesh(moved(octahedron_sphere(5), 1.01, {0, 0, 0}));
    BakeOptions options;
    options.quantity = BakedQuantity::relief;
    options.range = 0.02;
    const Mesh target = build_mesh(octahedron_sphere(5));
    const BakedMesh result = baked(target, source, 0.02, options);
    EXPECT_EQ(result.result.low, -0.02);
    EXPECT_EQ(result.result.high, 0.02);
    const auto expected = [](const Point&) { return std::array<double, 3>{191.25, 191.25, 191.25}; };  // 0.01 of -0.02 to 0.02
    EXPECT_LT(mean_error(target, result.extras, expected), 2);
    EXPECT_NEAR(result.result.counts.mean_distance, 0.01, 0.001);
}

TEST(Bake, CurvatureOfASphereIsTheSameEverywhere) {
    MeshFile source;
    source.mesh = build_mesh(moved(octahedron_sphere(5), 0.5, {0, 0, 0}));
    BakeOptions options;
    options.quantity = BakedQuantity::curvature;
    options.range = 4;
    const BakedMesh result = baked(source.mesh, source, 0.02, options);
    const double grey = 255 * (2 + 4) / 8.0;  // curvature 2 in -4 to 4
    const auto expected = [&](const Point&) { return std::array<double, 3>{grey, grey, grey}; };
    EXPECT_LT(mean_error(source.mesh, result.extras, expected), 6);
}

TEST(Bake, OcclusionOfAConvexShapeAndOfABowl) {
    MeshFile source;
    source.mesh = build_mesh(octahedron_sphere(4));
    BakeOptions options;
    options.quantity = BakedQuantity::occlusion;
    options.occlusion_distance = 2;
    options.occlusion_rays = 256;
    const auto all = [](double share) {
        return [share](const Point&) { return std::array<double, 3>{255 * share, 255 * share, 255 * share}; };
    };
    EXPECT_LT(mean_error(source.mesh, baked(source.mesh, source, 0.05, options).extras, all(1)), 2);
    // The inside of a sphere sees nothing but itself.
    TriangleSoup inside = octahedron_sphere(4);
    for (auto& t : inside.triangles) std::swap(t[0], t[1]);
    source.mesh = build_mesh(inside);
    EXPECT_LT(mean_error(source.mesh, baked(source.mesh, source, 0.05, options).extras, all(0)), 2);
    // Half a sphere seen from inside: the share of the sky, weighted by the cosine, is one half everywhere (sphere of radius 1:
    // the form factor of the opening is its area over that of the sphere, seen from any point of the sphere).
    TriangleSoup bowl;
    bowl.points = inside.points;
    for (const auto& t : inside.triangles)
        if (inside.points[t[0]][2] + inside.points[t[1]][2] + inside.points[t[2]][2] < 0) bowl.triangles.push_back(t);
    source.mesh = build_mesh(bowl);
    EXPECT_LT(mean_error(source.mesh, baked(source.mesh, source, 0.05, options).extras, all(0.5)), 6);
}

TEST(Bake, PlacesWithoutSourceAreFilledOrGrey) {
    MeshFile source = textured_box(6, 32, [](const Point&) { return std::array<double, 3>{200, 30, 30}; });
    // The target has a second cube far from the source.
    const Mesh target = build_mesh(joined(box(3), moved(box(3), 1, {5, 0, 0})));
    BakeOptions options;
    options.distance = 0.01;
    const BakedMesh filled = baked(target, source, 0.05, options);
    EXPECT_NEAR(static_cast<double>(filled.result.counts.without) / static_cast<double>(filled.result.counts.total()), 0.5, 0.1);
    for (const auto& pixel : filled.result.images[0].rgba) {
        EXPECT_NEAR(pixel[0], 200, 2);
        EXPECT_EQ(pixel[3], 255);
    }
    options.missing = BakeOptions::Missing::grey;
    const BakedMesh grey = baked(target, source, 0.05, options);
    std::size_t count = 0;
    for (const auto& pixel : grey.result.images[0].rgba) count += pixel[0] == 170 ? 1U : 0U;
    EXPECT_NEAR(static_cast<double>(count) / static_cast<double>(grey.result.images[0].rgba.size()), 0.5, 0.15);
}

TEST(Bake, ThinWallsShowTheirOwnSide) {
    // A plate of thickness 0.01: red above, blue below; the ray of 0.02 x diagonal reaches both.
    TriangleSoup soup = box(8);
    for (auto& p : soup.points) p[2] *= 0.01;
    MeshFile source;
    source.mesh = build_mesh(soup);
    for (const Face f : source.mesh.faces())
        source.extras.face_colours.push_back(area_vector(source.mesh, f).z() > 0 ? Colour{255, 0, 0, 255} : Colour{0, 0, 255, 255});
    TriangleSoup coarse = box(5);
    for (auto& p : coarse.points) p[2] *= 0.011;
    const Mesh target = build_mesh(coarse);
    const BakedMesh result = baked(target, source, 0.01);
    const TextureSampler sampler(result.extras.appearance, "plate");
    for (const Face f : target.faces()) {
        const Vector normal = area_vector(target, f);
        if (std::abs(normal.z()) < 1e-3) continue;
        TexturePoint middle{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 2; ++axis)
                middle[axis] += result.extras.corner_texture[3 * static_cast<std::size_t>(f) + k][axis] / 3;
        EXPECT_GT(sampler.colour(0, middle)[normal.z() > 0 ? 0 : 2], 0.9F) << f;
    }
}

TEST(Bake, IntoTextureCoordinatesThatAMeshHas) {
    const MeshFile source = textured_box(6, 64, waves), target = textured_box(4, 48, [](const Point&) {
        return std::array<double, 3>{0, 0, 0};
    });
    const TextureLayout layout = layout_of(target, "box");
    const BakeResult result = bake(target.mesh, layout, source, {}, "box");
    MeshExtras extras;
    set_texture(extras, layout, result.images, {ImageFormat::png, 92, "box"});
    EXPECT_LT(mean_error(target.mesh, extras, waves), 3);
}

TEST(Bake, IsTheSameForAnyNumberOfThreads) {
    const MeshFile source = textured_box(6, 48, waves);
    const Mesh target = build_mesh(torus(20, 10));
    const int before = threads();
    for (const BakedQuantity quantity : {BakedQuantity::colour, BakedQuantity::occlusion}) {
        BakeOptions options;
        options.quantity = quantity;
        options.distance = 0.5;
        options.occlusion_rays = 16;
        set_threads(1);
        const BakedMesh single = baked(target, source, 0.05, options);
        set_threads(4);
        const BakedMesh several = baked(target, source, 0.05, options);
        set_threads(before);
        EXPECT_EQ(single.result.images[0].rgba, several.result.images[0].rgba);
        EXPECT_EQ(single.result.counts.mean_distance, several.result.counts.mean_distance);
    }
}

TEST(Bake, DegenerateTargetsAndWrongLayouts) {
    const MeshFile source = textured_box(2, 16, waves);
    const Mesh one = build_mesh({{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}});
    EXPECT_GT(baked(one, source, 0.1).result.counts.total(), 20U);
    const Mesh flat = build_mesh({{{0, 0, 1}, {0.5, 0, 1}, {1, 0, 1}}, {{0, 1, 2}}});
    EXPECT_GT(baked(flat, source, 0.1).result.counts.total(), 0U);
    TextureLayout layout;
    EXPECT_THROW(bake(one, layout, source, {}, "box"), Error);
    layout.corner_texture = {{0, 0}, {1, 0}, {0, 1}};
    layout.width = layout.height = 8;
    EXPECT_THROW(bake(one, layout, source, {}, "box"), Error);  // no image
    layout.images = 1;
    layout.corner_texture[0] = {std::numeric_limits<float>::quiet_NaN(), 1e30F};
    EXPECT_EQ(bake(one, layout, source, {}, "box").counts.total(), 0U);
    layout.face_image = {3};
    EXPECT_THROW(bake(one, layout, source, {}, "box"), Error);
    MeshFile empty;
    empty.mesh = flat;
    layout.face_image = {0};
    EXPECT_THROW(bake(one, layout, empty, {}, "flat"), Error);
}

TEST(Bake, EmptyTexelsGetTheColoursAround) {
    Pixels pixels{64, 64, {}};
    pixels.rgba.assign(64 * 64, {0, 0, 0, 0});
    std::vector<bool> covered(64 * 64);
    const auto set = [&](std::size_t column, std::size_t row, std::array<std::uint8_t, 4> colour) {
        pixels.rgba[row * 64 + column] = colour;
        covered[row * 64 + column] = true;
    };
    set(5, 5, {255, 0, 0, 255});
    set(60, 60, {0, 0, 255, 255});
    texture::fill_empty(pixels, covered, 3);
    EXPECT_EQ(pixels.at(8, 2), (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
    EXPECT_EQ(pixels.at(57, 63), (std::array<std::uint8_t, 4>{0, 0, 255, 255}));
    for (const auto& pixel : pixels.rgba) {
        EXPECT_EQ(pixel[3], 255);
        EXPECT_GT(pixel[0] + pixel[2], 250);
    }
    Pixels none{5, 3, {}};
    none.rgba.resize(15);
    std::vector<bool> nothing(15);
    texture::fill_empty(none, nothing, 2);
    for (const auto& pixel : none.rgba) EXPECT_EQ(pixel[0], 170);
}
