// Scans and odd files as GLB and glTF: counts of an independent reader, and what is written of them.
#include "gltf_examples.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

struct Expected {
    std::string file;
    std::size_t vertices, triangles, materials;
    std::vector<std::array<int, 2>> images;  ///< width and height; {0, 0}: missing
    double area;
    std::array<double, 6> box;  ///< lowest and highest x, y, z
};

const std::vector<Expected>& expected_files() {
    const std::array<int, 2> two_k{2048, 2048}, small{256, 256}, tiny{2, 2}, none{0, 0};
    const std::array<double, 6> cube{-0.5, -0.5, -0.5, 0.5, 0.5, 0.5}, square{-0.5, -0.5, 0, 0.5, 0.5, 0},
        skull{-0.151357, -0.119099, -0.243713, 0.151393, 0.119076, 0.243653};
    static const std::vector<Expected> files{
        {"scan-mask-bali/mask-gltf-2.0_separated-valid.gltf",
         62383,
         100000,
         1,
         {{4096, 4096}},
         0.130907,
         {-0.115961, -0.132144, 0.0322379, 0.105356, 0.0928396, 0.159643}},
        {"scan-venus-de-milo/venus.glb",
         15634,
         24058,
         1,
         {two_k, two_k},
         3.66248e6,
         {-339.213, -0.546086, -280.121, 355.137, 2118.39, 357.507}},
        {"scan-whale-cranium/whale_cranium.glb", 57565, 100000, 1, {two_k, two_k}, 0.387346, skull},
        {"scan-whale-cranium/whale_cranium_draco.glb",
         57565,
         100000,
         1,
         {two_k, two_k},
         0.387355,
         {-0.151357, -0.119099, -0.243713, 0.151391, 0.119066, 0.243653}},
        {"scan-teapot/teapot.glb",
         58341,
         89952,
         1,
         {{64, 64}, {64, 64}},
         906440,
         {-310.086, 0.00263066, -187.762, 317.683, 651.51, 187.725}},
        {"scan-ycb-mustard-ktx2/006_mustard_bottle_textured.gltf",
         8423,
         16384,
         1,
         {none},
         0.0454998,
         {-0.063938, -0.003153, -0.009812, 0.03326, 0.188148, 0.056809}},
        {"scan-head-draco/LeePerrySmith.glb",
         9223,
         17684,
         1,
         {},
         145.701,
         {-4.27632, -3.97255, -2.59038, 4.27632, 3.97427, 2.59051}},
        {"scan-whale-mandible-draco/whale_mandible_draco.glb",
         56402,
         100000,
         1,
         {two_k, two_k},
         0.123331,
         {-0.136307, -0.054254, -0.184696, 0.136457, 0.0541934, 0.184679}},
        {"odd-glb-meshopt/BoxTextured_meshopt.glb", 24, 12, 1, {small}, 6, cube},
        {"odd-glb-meshopt/pirate.glb",
         2887,
         5010,
         0,
         {},
         3.85635,
         {-0.760582, -0.001088, -0.229468, 0.760505, 1.90396, 0.225777}},
        {"odd-glb-meshopt-fallback/BoxMeshopt.glb", 24, 12, 1, {}, 6, cube},
        {"odd-glb-meshopt-fallback/BoxMeshopt.gltf", 24, 12, 1, {}, 6, cube},
        {"odd-gltf-draco/BoxDraco.gltf", 24, 12, 1, {}, 6, cube},
        {"odd-gltf-draco/DracoSparseMesh.gltf",
         62,
         102,
         0,
         {},
         0.000287515,
         {-0.0396516, 0.0495865, 0.028699, -0.0134827, 0.0891258, 0.0316506}},
        {"odd-gltf-sparse-instances/SimpleSparseAccessor.gltf", 14, 12, 0, {}, 12, {0, 0, 0, 6, 4, 0}},
        {"odd-gltf-sparse-instances/mirror/one_face_123_mirror.gltf", 3, 1, 1, {}, 0.0949768, {-3, -0.109982, 0, -1, -0.01, 0}},
        {"odd-gltf-sparse-instances/mirror/one_face_123_translated.gltf",
         3,
         1,
         1,
         {},
         0.0949768,
         {-0.5, 5.01, 2.3, 1.5, 5.10998, 2.3}},
        {"odd-gltf-sparse-instances/spheres/spheres_scaled_instances.gltf", 693, 672, 0, {}, 121.789, {-3, -3, -3, 3, 3, 3}},
        {"odd-gltf-texture-transform/fallback/KhrTextureTransformWithFallback.gltf",
         24,
         12,
         1,
         {{1024, 1024}},
         24,
         {-1, -1, -1, 1, 1, 1}},
        {"odd-gltf-texture-transform/required/TextureTransformTestWithRequired.gltf",
         48,
         24,
         9,
         {small, {128, 128}, {128, 128}, {128, 128}, {128, 128}},
         6.11,
         {-1.6, -1.14127, 0, 1.6, 1.05, 0.01}},
        {"odd-gltf-vertex-colour-and-image/VertexColorTest.gltf",
         72,
         36,
         2,
         {small, small},
         10.004,
         {-1, -1, -0.0127411, 1, 1, 0.0613663}},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_04.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_05.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_06.gltf", 6, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_11.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_12.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_13.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_14.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-primitive-modes/Mesh_PrimitiveMode_15.gltf", 4, 2, 0, {}, 1, square},
        {"odd-gltf-uri-spaces/CubeImageUriMultipleSpaces.gltf", 24, 12, 1, {tiny}, 6, cube},
        {"odd-gltf-uri-spaces/CubeImageUriSpaces.gltf", 24, 12, 1, {tiny}, 6, cube},
        {"odd-gltf-embedded/BoxTextured.glb", 24, 12, 1, {small}, 6, cube},
        {"odd-gltf-embedded/BoxTextured.gltf", 24, 12, 1, {small}, 6, cube},
        {"odd-gltf-broken-2/zero-sized-bin-chunk-issue-440.glb", 3, 1, 1, {}, 0.5, {0, 0, 0, 1, 1, 0}},
    };
    return files;
}

Path shared_file(const std::string& name) { return Path(OSTRAKA_SHARED_DATA) / "textured" / name; }

PolygonSoup read_shared(const std::string& name) {
    const Path file = shared_file(name);
    return io::read_gltf(read_file(file), file.string());
}

bool is_missing() { return !std::filesystem::exists(Path(OSTRAKA_SHARED_DATA) / "textured"); }

bool has_note(const PolygonSoup& soup, const std::string& part) {
    for (const std::string& note : soup.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

void expect_same_appearance(const MeshExtras& a, const MeshExtras& b) {
    ASSERT_EQ(a.appearance.materials.size(), b.appearance.materials.size());
    EXPECT_EQ(a.face_materials, b.face_materials);
    for (std::size_t m = 0; m < a.appearance.materials.size(); ++m) {
        const Material &p = a.appearance.materials[m], &q = b.appearance.materials[m];
        EXPECT_EQ(p.name, q.name);
        EXPECT_EQ(p.base_colour, q.base_colour);
        EXPECT_EQ(p.wrap_u, q.wrap_u);
        EXPECT_EQ(p.wrap_v, q.wrap_v);
        EXPECT_EQ(p.nearest, q.nearest);
        EXPECT_EQ(p.alpha, q.alpha);
        EXPECT_EQ(p.double_sided, q.double_sided);
        const auto image_of = [](const MeshExtras& extras, const Material& material) {
            return material.image == no_index ? nullptr : extras.appearance.images.at(material.image);
        };
        const SharedImage x = image_of(a, p), y = image_of(b, q);
        ASSERT_EQ(x == nullptr, y == nullptr);
        if (x == nullptr) continue;
        EXPECT_EQ(x->bytes, y->bytes);
    }
}

}  // namespace

TEST(GltfFiles, HaveTheCountsOfAnIndependentReader) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    for (const Expected& expected : expected_files()) {
        SCOPED_TRACE(expected.file);
        const PolygonSoup soup = read_shared(expected.file);
        EXPECT_EQ(soup.points.size(), expected.vertices);
        EXPECT_EQ(soup.polygon_count(), expected.triangles);
        EXPECT_EQ(soup.extras.appearance.materials.size(), expected.materials);
        EXPECT_EQ(soup.extras.face_materials.size(), expected.materials == 0 ? 0 : expected.triangles);
        std::vector<std::array<int, 2>> images;
        for (const SharedImage& image : soup.extras.appearance.images)
            images.push_back(image == nullptr ? std::array{0, 0} : std::array{image->width, image->height});
        EXPECT_EQ(images, expected.images);
        EXPECT_NEAR(area_of(soup), expected.area, 1e-5 * expected.area);
        for (std::size_t k = 0; k < 3; ++k) {
            double low = soup.points[0][k], high = low;
            for (const auto& point : soup.points) low = std::min(low, point[k]), high = std::max(high, point[k]);
            EXPECT_NEAR(low, expected.box[k], 1e-5 * std::max(1.0, std::abs(expected.box[k])));
            EXPECT_NEAR(high, expected.box[k + 3], 1e-5 * std::max(1.0, std::abs(expected.box[k + 3])));
        }
        for (const auto& [u, v] : soup.extras.corner_texture) ASSERT_TRUE(std::isfinite(u) && std::isfinite(v));
    }
}

TEST(GltfFiles, AreTheSameAfterWriting) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    const Scratch scratch;
    for (const Expected& expected : expected_files()) {
        SCOPED_TRACE(expected.file);
        const PolygonSoup soup = read_shared(expected.file);
        const Path file = scratch / "a.glb";
        io::write_glb(file, triangles_of(soup), soup.extras, {});
        const PolygonSoup copy = io::read_gltf(read_file(file), file.string());
        ASSERT_EQ(copy.corners.size(), soup.corners.size());
        for (std::size_t c = 0; c < soup.corners.size(); ++c)
            for (std::size_t k = 0; k < 3; ++k)
                ASSERT_EQ(copy.points[copy.corners[c]][k],
                          static_cast<double>(static_cast<float>(soup.points[soup.corners[c]][k])));
        ASSERT_EQ(copy.extras.corner_texture.size(), soup.extras.corner_texture.size());
        for (std::size_t c = 0; c < soup.extras.corner_texture.size(); ++c)
            for (std::size_t k = 0; k < 2; ++k)
                ASSERT_NEAR(copy.extras.corner_texture[c][k], soup.extras.corner_texture[c][k], 1e-6);
        ASSERT_EQ(copy.extras.vertex_colours.empty(), soup.extras.vertex_colours.empty());
        for (std::size_t c = 0; c < soup.corners.size() && !copy.extras.vertex_colours.empty(); ++c)
            ASSERT_EQ(copy.extras.vertex_colours[copy.corners[c]], soup.extras.vertex_colours[soup.corners[c]]);
        // A material whose only property is a missing image is not written.
        if (expected.images != std::vector<std::array<int, 2>>{{0, 0}}) expect_same_appearance(copy.extras, soup.extras);
    }
}

TEST(GltfFiles, CompressedAndPlainScansAreTheSameSurface) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    const PolygonSoup plain = read_shared("scan-whale-cranium/whale_cranium.glb"),
                      draco = read_shared("scan-whale-cranium/whale_cranium_draco.glb");
    // Draco orders vertices anew: their centres agree to its quantisation, and so do the texture coordinates.
    for (std::size_t k = 0; k < 3; ++k) {
        double a = 0, b = 0;
        for (const Index corner : plain.corners) a += plain.points[corner][k];
        for (const Index corner : draco.corners) b += draco.points[corner][k];
        EXPECT_NEAR(a / static_cast<double>(plain.corners.size()), b / static_cast<double>(draco.corners.size()), 2e-5);
    }
    for (std::size_t k = 0; k < 2; ++k) {
        double a = 0, b = 0;
        for (const auto& point : plain.extras.corner_texture) a += point[k];
        for (const auto& point : draco.extras.corner_texture) b += point[k];
        EXPECT_NEAR(a / static_cast<double>(plain.corners.size()), b / static_cast<double>(draco.corners.size()), 2e-4);
    }
}

TEST(GltfFiles, TextureTransformsTurnAsTheTestModelShows) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    // The image of the turned square shows an arrow from its corner at the top left; the marker "correct" lies where the tip
    // must appear, the marker "not supported" where it appears without the transform.
    const PolygonSoup soup = read_shared("odd-gltf-texture-transform/required/TextureTransformTestWithRequired.gltf");
    const auto& materials = soup.extras.appearance.materials;
    const auto faces_of = [&](const std::string& name) {
        std::vector<std::size_t> faces;
        for (std::size_t f = 0; f < soup.polygon_count(); ++f)
            if (materials[soup.extras.face_materials[f]].name == name) faces.push_back(f);
        return faces;
    };
    // Affine on the square: texture coordinates from positions relative to the centre (-1.1, -0.55).
    const std::size_t corner = 3 * faces_of("Rotation").at(0);
    const auto at = [&](double x, double y) {
        std::array<double, 2> value{};
        const auto &a = soup.points[soup.corners[corner]], &b = soup.points[soup.corners[corner + 1]],
                   &c = soup.points[soup.corners[corner + 2]];
        const double determinant = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        const double s = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / determinant,
                     t = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / determinant;
        const auto& texture = soup.extras.corner_texture;
        for (std::size_t k = 0; k < 2; ++k)
            value[k] = (1 - s - t) * texture[corner][k] + s * texture[corner + 1][k] + t * texture[corner + 2][k];
        return value;
    };
    const auto correct = at(-1.1 - 0.0790482, -0.55 - 0.5162675);
    EXPECT_NEAR(correct[0], 0.5 + 0.2778175, 1e-5);
    EXPECT_NEAR(correct[1], 1 - (0.5 + 0.2778175), 1e-5);
    EXPECT_EQ(materials[soup.extras.face_materials[faces_of("Rotation").at(0)]].wrap_u, TextureWrap::clamp);
}

TEST(GltfFiles, QuantisedTextureCoordinatesCoverTheImage) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    for (const std::string name : {"odd-glb-meshopt/BoxTextured_meshopt.glb", "odd-gltf-embedded/BoxTextured.glb"}) {
        SCOPED_TRACE(name);
        double low = 1e9, high = -1e9;
        for (const auto& point : read_shared(name).extras.corner_texture)
            low = std::min<double>(low, point[0]), high = std::max<double>(high, point[0]);
        EXPECT_NEAR(low, 0, 1e-3);
        EXPECT_NEAR(high, 6, 1e-3);
    }
}

TEST(GltfFiles, PointsAndMissingImagesAreReported) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    for (const std::string number : {"00", "07"}) {
        const PolygonSoup soup = read_shared("odd-gltf-primitive-modes/Mesh_PrimitiveMode_" + number + ".gltf");
        EXPECT_EQ(soup.polygon_count(), 0U);
        EXPECT_EQ(soup.points.size(), 1024U);
        EXPECT_TRUE(has_note(soup, "1024 points"));
    }
    for (const std::string number : {"01", "02", "03", "08", "09", "10"}) {
        const PolygonSoup soup = read_shared("odd-gltf-primitive-modes/Mesh_PrimitiveMode_" + number + ".gltf");
        EXPECT_EQ(soup.polygon_count(), 0U);
        EXPECT_TRUE(has_note(soup, "lines")) << number;
    }
    const PolygonSoup bottle = read_shared("scan-ycb-mustard-ktx2/006_mustard_bottle_textured.gltf");
    EXPECT_TRUE(has_note(bottle, "006_mustard_bottle_textured.png"));
    EXPECT_TRUE(has_note(bottle, "KTX2"));
    EXPECT_EQ(bottle.extras.corner_texture.size(), 3 * bottle.polygon_count());
    const PolygonSoup venus = read_shared("scan-venus-de-milo/venus.glb");
    EXPECT_TRUE(has_note(venus, "CC0-1.0"));
    EXPECT_NE(venus.extras.appearance.materials[0].gltf_rest.find("normalTexture"), std::string::npos);
    EXPECT_NEAR(venus.extras.appearance.materials[0].base_colour[0], 0.608, 1e-3);
}

TEST(GltfFiles, BrokenFilesAreRefusedWithASentence) {
    if (is_missing()) GTEST_SKIP() << "no " << OSTRAKA_SHARED_DATA << "/textured";
    const std::vector<std::pair<std::string, std::string>> broken{
        {"odd-gltf-broken/BoxWithInfinites.glb", "not finite"},
        {"odd-gltf-broken/IndexOutOfRange/AllIndicesOutOfRange.gltf", "out of range"},
        {"odd-gltf-broken/IndexOutOfRange/IndexOutOfRange.gltf", "out of range"},
        {"odd-gltf-broken/MissingBin/BoxTextured.gltf", "BoxTextured0.bin"},
        {"odd-gltf-broken/RecursiveNodes/RecursiveNodes.gltf", "cycle"},
        {"odd-gltf-broken-2/BoundsChecking/integer-out-of-bounds.gltf", ""},
        {"odd-gltf1/BoxTextured.glb", "glTF 1.0"},
        {"odd-gltf1/BoxTextured.gltf", "glTF 1.0"},
    };
    for (const auto& [name, part] : broken) {
        const Path file = shared_file(name);
        const std::string problem = problem_of(read_file(file), file.string());
        EXPECT_FALSE(problem.empty()) << name;
        EXPECT_NE(problem.find(part), std::string::npos) << name << ": " << problem;
    }
    // Nothing in these can be shown: their primitives have no positions, or their scenes no meshes.
    for (const std::string name :
         {"odd-gltf-broken/TestNoRootNode/NoScene.gltf", "odd-gltf-broken/TestNoRootNode/SceneWithoutNodes.gltf",
          "odd-gltf-broken-2/issue-416.gltf", "odd-gltf-broken-2/issue-492.glb",
          "odd-gltf-broken-2/BoundsChecking/invalid-buffer-index.gltf",
          "odd-gltf-broken-2/BoundsChecking/invalid-buffer-view-index.gltf",
          "odd-gltf-broken-2/BoundsChecking/invalid-primitive-indices.gltf"})
        EXPECT_EQ(read_shared(name).polygon_count(), 0U) << name;
}
