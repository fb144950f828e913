// glTF files built in the test: transforms, modes, components, colours, materials; what the writer makes of them; hostile files.
#include "gltf_examples.h"
#include "mutate.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

constexpr const char* triangle_accessor = R"(,"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])";
constexpr const char* plain_primitive = R"({"attributes":{"POSITION":0}})";

using Point3 = std::array<double, 3>;

/// The right triangle shown by a node with these further members.
PolygonSoup placed(const std::string& node) {
    return read_memory(glb_of(one_primitive(plain_primitive, triangle_accessor + views({36}), "," + node), right_triangle()));
}

/// A square of four vertices and this mode, with 8-bit indices.
PolygonSoup of_mode(int mode, const std::vector<std::uint8_t>& indices) {
    const std::string binary = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) + bytes_of(indices);
    return read_memory(
        glb_of(one_primitive(R"({"attributes":{"POSITION":0},"indices":1,"mode":)" + std::to_string(mode) + "}",
                             R"(,"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
                             R"({"bufferView":1,"componentType":5121,"count":)" +
                                 std::to_string(indices.size()) + R"(,"type":"SCALAR"}])" + views({48, indices.size()})),
               binary));
}

TriangleSoup square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

/// A PNG of one white pixel.
std::string white_pixel() {
    const Pixels pixels{1, 1, {{255, 255, 255, 255}}};
    return encode(pixels, ImageFormat::png, "white.png").bytes;
}

PolygonSoup written_and_read(const TriangleSoup& soup, const MeshExtras& extras, io::Notes* notes = nullptr) {
    const Scratch scratch;
    const Path file = scratch / "a.glb";
    const io::Notes written = io::write_glb(file, soup, extras, {});
    if (notes != nullptr) *notes = written;
    return io::read_gltf(read_file(file), file.string());
}

}  // namespace

TEST(Gltf, NodesTransform) {
    EXPECT_EQ(placed(R"("translation":[1e7,0.25,-3])").points[1], (Point3{1e7 + 1, 0.25, -3}));
    EXPECT_EQ(placed(R"("scale":[2,3,4])").points[2], (Point3{0, 3, 0}));
    // Column by column: x becomes y, y becomes z, moved by 5 along x.
    const PolygonSoup turned = placed(R"("matrix":[0,1,0,0, 0,0,1,0, 1,0,0,0, 5,0,0,1])");
    EXPECT_EQ(turned.points[1], (Point3{5, 1, 0}));
    EXPECT_EQ(turned.points[2], (Point3{5, 0, 1}));
    // A quarter turn about z, then moved; the scale is applied first.
    const double half = std::sqrt(0.5);
    const PolygonSoup quarter = placed(R"("translation":[1,2,3],"scale":[2,1,1],"rotation":[0,0,)" + std::to_string(half) + "," +
                                       std::to_string(half) + "]");
    EXPECT_NEAR(quarter.points[1][0], 1, 1e-12);
    EXPECT_NEAR(quarter.points[1][1], 4, 1e-12);
    EXPECT_EQ(quarter.corners, (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(placed(R"("scale":[-1,1,1])").corners, (std::vector<Index>{0, 2, 1}));
    EXPECT_EQ(placed(R"("scale":[2,2,2],"extras":{"ostraka-display":true})").points[1], (Point3{1, 0, 0}));
}

TEST(Gltf, NodesAreReachedOnce) {
    const std::string rest = R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])" + (triangle_accessor + views({36}));
    const auto read = [&](const std::string& nodes, const std::string& scene = R"("scenes":[{"nodes":[0]}],)") {
        return glb_of("{" + scene + R"("nodes":)" + nodes + rest + "}", right_triangle());
    };
    const PolygonSoup chain =
        read_memory(read(R"([{"children":[1,2],"translation":[1,0,0]},{"mesh":0,"translation":[0,1,0]},{"mesh":0}])"));
    EXPECT_EQ(chain.points[0], (Point3{1, 1, 0}));
    EXPECT_EQ(chain.points[3], (Point3{1, 0, 0}));
    EXPECT_NE(problem_of(read(R"([{"children":[1]},{"children":[0]}])")).find("cycle"), std::string::npos);
    EXPECT_NE(problem_of(read(R"([{"children":[1]},{"children":[0]}])", "")).find("cycle"), std::string::npos);
    EXPECT_NE(problem_of(read(R"([{"children":[1,1]},{"mesh":0}])")).find("twice"), std::string::npos);
    EXPECT_NE(problem_of(read(R"([{"children":[7]}])")).find("node 7"), std::string::npos);
    EXPECT_NE(problem_of(read(R"([{"mesh":4}])")).find("no mesh 4"), std::string::npos);
    EXPECT_EQ(read_memory(read(R"([{"mesh":0},{"mesh":0}])", "")).polygon_count(), 2U) << "all roots without a scene";
    EXPECT_EQ(read_memory(read(R"([{"mesh":0},{"mesh":0}])")).polygon_count(), 1U) << "the default scene";
    // A chain of nodes far deeper than the stack of calls.
    std::string deep = "[";
    for (int i = 1; i <= 100000; ++i) deep += R"({"children":[)" + std::to_string(i) + "]},";
    EXPECT_EQ(read_memory(read(deep + R"({"mesh":0}])")).polygon_count(), 1U);
}

TEST(Gltf, StripsAndFansKeepTheirOrientation) {
    EXPECT_EQ(of_mode(4, {0, 1, 2, 2, 1, 3}).corners, (std::vector<Index>{0, 1, 2, 2, 1, 3}));
    EXPECT_EQ(of_mode(5, {0, 1, 2, 3}).corners, (std::vector<Index>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(of_mode(6, {0, 1, 3, 2}).corners, (std::vector<Index>{1, 3, 0, 3, 2, 0}));
    EXPECT_EQ(of_mode(4, {0, 0, 1}).polygon_count(), 1U) << "degenerate triangles are kept";
    EXPECT_EQ(of_mode(4, {0, 1, 2, 3}).polygon_count(), 1U) << "corners that complete no triangle";
    EXPECT_EQ(of_mode(5, {0, 1}).polygon_count(), 0U);
}

TEST(Gltf, IntegersAreFractionsWhereTheFileSaysSo) {
    const auto read = [](int component, const std::string& binary, std::size_t stride, const std::string& normalised) {
        return read_memory(
                   glb_of(one_primitive(plain_primitive, R"(,"accessors":[{"bufferView":0,"componentType":)" +
                                                             std::to_string(component) + R"(,"count":3,"type":"VEC3")" +
                                                             normalised + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" +
                                                             std::to_string(binary.size()) + R"(,"byteStride":)" +
                                                             std::to_string(stride) + R"(}],"buffers":[{"byteLength":99}])"),
                          binary))
            .points;
    };
    const std::string yes = R"(,"normalized":true)";
    const std::string bytes = bytes_of<std::int8_t>({127, -128, -127, 0, 0, 127, 0, 0, 0, 0, 127, 0});
    EXPECT_EQ(read(5120, bytes, 4, yes)[0], (Point3{1, -1, -1}));
    EXPECT_EQ(read(5120, bytes, 4, "")[0], (Point3{127, -128, -127}));
    const std::string shorts = bytes_of<std::uint16_t>({65535, 0, 13107, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    EXPECT_EQ(read(5123, shorts, 8, yes)[0], (Point3{1, 0, 0.2}));
    EXPECT_EQ(read(5123, shorts, 8, "")[0], (Point3{65535, 0, 13107}));
}

TEST(Gltf, SparseAccessorsAndAccessorsWithoutData) {
    // Zeros, of which elements 1 and 2 are replaced.
    const std::string binary = bytes_of<std::uint16_t>({1, 2}) + bytes_of<float>({1, 0, 0, 0, 1, 0});
    const auto file = [&](const std::string& count, const std::string& indices) {
        return glb_of(one_primitive(plain_primitive,
                                    R"(,"accessors":[{"componentType":5126,"count":)" + count +
                                        R"(,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":0,"componentType":)" +
                                        indices + R"(},"values":{"bufferView":1}}}])" + views({4, 24})),
                      binary);
    };
    const PolygonSoup soup = read_memory(file("3", "5123"));
    EXPECT_EQ(soup.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_NE(problem_of(file("2", "5123")).find("out of range"), std::string::npos);
    EXPECT_NE(problem_of(file("3", "5126")).find("unsigned"), std::string::npos);
    EXPECT_NE(problem_of(file("3", "5125")).find("exceeds its bufferView"), std::string::npos);
    EXPECT_NE(problem_of(file("4000000000", "5123")).find("MB"), std::string::npos) << "zeros that the file does not have";
}

TEST(Gltf, BuffersInsideAndBeside) {
    const Scratch scratch;
    const auto json = [&](const std::string& uri) {
        std::string text = one_primitive(plain_primitive, triangle_accessor + views({36}));
        text.insert(text.rfind("\"byteLength\""), R"("uri":")" + uri + R"(",)");
        return text;
    };
    const std::string name = (scratch / "a.gltf").string();
    const auto read = [&](const std::string& text) { return io::read_gltf(text, name).polygon_count(); };
    EXPECT_EQ(read(json("data:application/octet-stream;base64," + base64_of(right_triangle()))), 1U);
    EXPECT_EQ(read("\xEF\xBB\xBF " + json("data:;base64," + base64_of(right_triangle()))), 1U) << "byte order mark";
    write_file(scratch / "my buffer.bin", right_triangle());
    EXPECT_EQ(read(json("my%20buffer.bin")), 1U);
    EXPECT_EQ(read(json("my buffer.bin")), 1U);
    EXPECT_NE(problem_of(json("other.bin"), name).find("other.bin"), std::string::npos);
    EXPECT_NE(problem_of(json("data:;base64,!!!!"), name).find("base64"), std::string::npos);
    EXPECT_NE(problem_of(json("data:;base64,AAAA"), name).find("exceeds the buffer"), std::string::npos);
}

TEST(Gltf, UnsupportedExtensionsAreNamed) {
    const auto file = [](const std::string& member, const std::string& name) {
        return glb_of(one_primitive(plain_primitive, triangle_accessor + views({36}) + ",\"" + member + "\":[\"" + name + "\"]"),
                      right_triangle());
    };
    EXPECT_NE(problem_of(file("extensionsRequired", "KHR_gaussian")).find("KHR_gaussian"), std::string::npos);
    EXPECT_EQ(problem_of(file("extensionsRequired", "KHR_materials_unlit")), "");
    EXPECT_NE(read_memory(file("extensionsUsed", "EXT_something")).notes.at(0).find("EXT_something"), std::string::npos);
    EXPECT_NE(problem_of(R"({"asset":{"version":"1.0"},"meshes":{}})").find("glTF 1.0"), std::string::npos);
    EXPECT_NE(problem_of(R"({"asset":{"version":"3.0"}})").find("version 3.0"), std::string::npos);
}

TEST(Gltf, ColoursAreLinearLight) {
    const std::string binary = right_triangle() + bytes_of<float>({1, 0.2158605F, 0, 0.5F, 2, -1, std::nanf(""), 1, 0, 0, 0, 0});
    const PolygonSoup soup =
        read_memory(glb_of(one_primitive(R"({"attributes":{"POSITION":0,"COLOR_0":1}})",
                                         R"(,"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
                                         R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"}])" +
                                             views({36, 48})),
                           binary));
    const std::vector<Colour> expected{{255, 128, 0, 128}, {255, 0, 0, 255}, {0, 0, 0, 0}};
    EXPECT_EQ(soup.extras.vertex_colours, expected);
    MeshExtras extras;
    TriangleSoup mesh = square();
    std::vector<Colour> all;
    for (int i = 0; i < 256; ++i) {
        mesh.points.push_back({double(i), 2, 0});
        const auto c = static_cast<std::uint8_t>(i);
        all.push_back({c, static_cast<std::uint8_t>(255 - i), c, c});
    }
    extras.vertex_colours.assign(4, {9, 8, 7, 255});
    extras.vertex_colours.insert(extras.vertex_colours.end(), all.begin(), all.end());
    const PolygonSoup copy = written_and_read(mesh, extras);
    EXPECT_EQ(copy.extras.vertex_colours, extras.vertex_colours) << "every sRGB byte survives";
    EXPECT_TRUE(copy.extras.appearance.empty());
    EXPECT_TRUE(copy.extras.face_materials.empty());
}

TEST(Gltf, PrimitivesOfOneMeshShareTheirVertices) {
    const std::string binary =
        bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) + bytes_of<std::uint16_t>({0, 1, 2, 2, 1, 3});
    const PolygonSoup soup = read_memory(glb_of(
        one_primitive(
            R"({"attributes":{"POSITION":0},"indices":1,"material":0},{"attributes":{"POSITION":0},"indices":2,"material":1})",
            R"(,"materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}},{}],)"
            R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
            R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},)"
            R"({"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,"type":"SCALAR"}])" +
                views({48, 12})),
        binary));
    EXPECT_EQ(soup.points.size(), 4U);
    ASSERT_EQ(soup.extras.appearance.materials.size(), 1U);
    EXPECT_EQ(soup.extras.appearance.materials[0].name, "red");
    EXPECT_EQ(soup.extras.face_materials, (std::vector<Index>{0, no_index})) << "the default material is none";
}

TEST(Gltf, MaterialsComeBackAsTheyWere) {
    MeshExtras extras;
    extras.corner_texture = {{0, 0}, {1, 0}, {1, 1}, {0.25F, 0}, {1, 1}, {0, 1}};
    const auto image = std::make_shared<const Image>(parse_image(white_pixel(), "white.png", "test"));
    const auto webp = std::make_shared<const Image>(encode(decode(*image, "test"), ImageFormat::webp, "other.webp", 100));
    extras.appearance.images = {image, webp};
    Material painted, glass;
    painted.name = "painted";
    painted.image = 1;
    painted.base_colour = {0.5F, 0.25F, 1, 1};
    painted.wrap_u = TextureWrap::mirror;
    painted.nearest = true;
    painted.alpha = Material::Alpha::mask;
    painted.alpha_cutoff = 0.75F;
    painted.double_sided = false;
    painted.gltf_rest =
        R"({"normalTexture":{"index":0,"scale":2},"extensions":{"KHR_materials_clearcoat":{"clearcoatTexture":{"index":1}}}})";
    glass.name = "glass";
    glass.alpha = Material::Alpha::blend;
    glass.base_colour[3] = 0.5F;
    extras.appearance.materials = {glass, painted};
    extras.face_materials = {1, 0};
    const PolygonSoup copy = written_and_read(square(), extras);
    EXPECT_EQ(copy.extras.face_materials, extras.face_materials);
    EXPECT_EQ(copy.corners.size(), 6U);
    EXPECT_EQ(copy.points.size(), 5U) << "the seam doubles vertex 0";
    for (std::size_t c = 0; c < 6; ++c)
        EXPECT_EQ(copy.points[copy.corners[c]], square().points[square().triangles[c / 3][c % 3]]);
    EXPECT_EQ(copy.extras.corner_texture, extras.corner_texture);
    ASSERT_EQ(copy.extras.appearance.materials.size(), 2U);
    const Material& read = copy.extras.appearance.materials[1];
    EXPECT_EQ(read.name, "painted");
    EXPECT_EQ(read.base_colour, painted.base_colour);
    EXPECT_EQ(read.wrap_u, TextureWrap::mirror);
    EXPECT_EQ(read.wrap_v, TextureWrap::repeat);
    EXPECT_TRUE(read.nearest);
    EXPECT_EQ(read.alpha, Material::Alpha::mask);
    EXPECT_EQ(read.alpha_cutoff, 0.75F);
    EXPECT_FALSE(read.double_sided);
    const auto& images = copy.extras.appearance.images;
    ASSERT_EQ(images.size(), 2U);
    EXPECT_EQ(images.at(read.image)->bytes, webp->bytes);
    const Json rest = parse_json(read.gltf_rest, "rest");
    EXPECT_EQ(images.at(rest["normalTexture"]["index"].GetUint())->bytes, image->bytes);
    EXPECT_EQ(rest["normalTexture"]["scale"].GetInt(), 2);
    EXPECT_EQ(images.at(rest["extensions"]["KHR_materials_clearcoat"]["clearcoatTexture"]["index"].GetUint())->bytes,
              webp->bytes);
    EXPECT_EQ(copy.extras.appearance.materials[0].alpha, Material::Alpha::blend);
}

TEST(Gltf, TheOrderOfTrianglesSurvivesMaterials) {
    TriangleSoup strip;
    MeshExtras extras;
    for (Index i = 0; i < 12; ++i) strip.points.push_back({double(i / 2), double(i % 2), 0});
    for (Index i = 0; i < 10; ++i) {
        strip.triangles.push_back({i, i + 1, i + 2});
        extras.face_materials.push_back(i % 3 == 2 ? no_index : i % 3);
        for (Index k = 0; k < 3; ++k) extras.corner_texture.push_back({static_cast<float>(i + k) / 16, 0.5F});
    }
    extras.appearance.materials.resize(2);
    extras.appearance.materials[0].base_colour = {1, 0, 0, 1};
    extras.appearance.materials[1].base_colour = {0, 1, 0, 1};
    const PolygonSoup copy = written_and_read(strip, extras);
    EXPECT_EQ(copy.points, strip.points);
    for (std::size_t c = 0; c < 30; ++c) EXPECT_EQ(copy.corners[c], strip.triangles[c / 3][c % 3]);
    EXPECT_EQ(copy.extras.face_materials, extras.face_materials);
    EXPECT_EQ(copy.extras.corner_texture, extras.corner_texture);
}

TEST(Gltf, SpecularGlossinessGivesItsDiffuseColour) {
    const PolygonSoup soup =
        read_memory(glb_of(one_primitive(R"({"attributes":{"POSITION":0},"material":0})",
                                         R"(,"materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":)"
                                         R"({"diffuseFactor":[0.5,0.25,0,1],"glossinessFactor":0.3}}}])" +
                                             (triangle_accessor + views({36}))),
                           right_triangle()));
    ASSERT_EQ(soup.extras.appearance.materials.size(), 1U);
    EXPECT_EQ(soup.extras.appearance.materials[0].base_colour, (std::array<float, 4>{0.5F, 0.25F, 0, 1}));
    EXPECT_EQ(soup.extras.appearance.materials[0].gltf_rest, "{}");
}

TEST(Gltf, MeshesFarAwayKeepTheirShape) {
    TriangleSoup far = square();
    for (auto& point : far.points) point = {4.5e5 + 0.05 * point[0], 5.2e6 + 0.05 * point[1], 100 + 0.05 * point[2]};
    io::Notes notes;
    const PolygonSoup copy = written_and_read(far, {}, &notes);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(copy.points[i][k], far.points[i][k], 0.0001 * 0.05);
    ASSERT_EQ(notes.size(), 2U);
    EXPECT_NE(notes[1].find("translation"), std::string::npos);
    // Coordinates that single precision holds well enough are written as they are.
    const PolygonSoup near = written_and_read(square(), {}, &notes);
    EXPECT_EQ(near.points, square().points);
    EXPECT_TRUE(notes.empty());
}

TEST(Gltf, ClaimsBeyondTheFileAreRefused) {
    const auto accessor = [](const std::string& count) {
        return R"(,"accessors":[{"bufferView":0,"componentType":5126,"count":)" + count + R"(,"type":"VEC3"}])";
    };
    const auto file = [&](const std::string& rest) { return glb_of(one_primitive(plain_primitive, rest), right_triangle()); };
    for (const std::string count : {"4", "4294967295", "99999999999", "-1", "1.5"})
        EXPECT_NE(problem_of(file(accessor(count) + views({36}))), "") << count;
    EXPECT_NE(problem_of(file(accessor("3") +
                              R"(,"bufferViews":[{"buffer":0,"byteOffset":4294967290,"byteLength":36}],"buffers":[{}])")),
              "");
    EXPECT_NE(problem_of(file(accessor("3") + R"(,"bufferViews":[{"buffer":9,"byteLength":36}],"buffers":[{}])")), "");
    for (const std::string mode : {"ATTRIBUTES", "TRIANGLES", "INDICES", "OTHER"})
        for (const std::string count : {"3", "4294967294", "0"})
            EXPECT_NE(problem_of(file(accessor("3") +
                                      R"(,"bufferViews":[{"buffer":1,"byteLength":36,"extensions":{)"
                                      R"("EXT_meshopt_compression":{"buffer":0,"byteLength":36,"byteStride":12,"count":)" +
                                      count + R"(,"mode":")" + mode + R"("}}}],"buffers":[{},{"byteLength":36}])")),
                      "");
    // A Draco header that states many faces.
    const std::string draco =
        std::string("DRACO\2\2\1\1\0\0\0", 12) + std::string("\xff\xff\xff\xff\x0f\xff\xff\xff\xff\x05\0", 11);
    const std::string compressed =
        glb_of(one_primitive(R"({"attributes":{"POSITION":0},"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)"
                             R"("attributes":{"POSITION":0}}}})",
                             R"(,"accessors":[{"componentType":5126,"count":3,"type":"VEC3"}])" + views({23})),
               draco);
    EXPECT_NE(problem_of(compressed).find("MB"), std::string::npos) << problem_of(compressed);
    // Many nodes with one large mesh.
    const std::string large(1 << 20, '\0');
    std::string nodes = R"({"scenes":[{"nodes":[)", list;
    for (int i = 0; i < 2000; ++i) {
        nodes += (i > 0 ? "," : "") + std::to_string(i);
        list += std::string(i > 0 ? "," : "") + R"({"mesh":0})";
    }
    const std::string instances = nodes + R"(]}],"nodes":[)" + list + R"(],"meshes":[{"primitives":[)" + plain_primitive + "]}]" +
                                  R"(,"accessors":[{"bufferView":0,"componentType":5126,"count":87381,"type":"VEC3"}])" +
                                  views({1 << 20}) + "}";
    EXPECT_NE(problem_of(glb_of(instances, large)).find("repeatedly"), std::string::npos);
}

TEST(Gltf, DamagedFilesGiveAMeshOrAnError) {
    MeshExtras extras;
    extras.vertex_colours.assign(4, {200, 100, 50, 255});
    extras.corner_texture = {{0, 0}, {1, 0}, {1, 1}, {0.25F, 0}, {1, 1}, {0, 1}};
    extras.appearance.images = {std::make_shared<const Image>(parse_image(white_pixel(), "white.png", "test"))};
    extras.appearance.materials.resize(2);
    extras.appearance.materials[0].image = 0;
    extras.appearance.materials[1].base_colour = {1, 0, 0, 1};
    extras.face_materials = {1, 0};
    const Scratch scratch;
    io::write_glb(scratch / "a.glb", square(), extras, {});
    std::vector<std::string> files{read_file(scratch / "a.glb")};
    const Path shared = Path(OSTRAKA_SHARED_DATA) / "textured";
    for (const char* name : {"odd-glb-meshopt-fallback/BoxMeshopt.glb", "odd-gltf-embedded/BoxTextured.gltf"})
        if (std::filesystem::exists(shared / name)) files.push_back(read_file(shared / name));
    if (std::filesystem::exists(shared / "odd-gltf-draco/BoxDraco.gltf")) {
        std::string draco = read_file(shared / "odd-gltf-draco/BoxDraco.gltf");
        const std::string uri = "data:;base64," + base64_of(read_file(shared / "odd-gltf-draco/0.bin"));
        files.push_back(draco.replace(draco.find("0.bin"), 5, uri));
    }
    for (const std::string& bytes : files) {
        ASSERT_EQ(problem_of(bytes), "");
        for (std::size_t size = 0; size + 8 < bytes.size(); size += 1 + bytes.size() / 2000) {
            const std::string cut = bytes.substr(0, size);
            EXPECT_NE(problem_of(cut), "") << size;
        }
        std::size_t refused = 0;
        for (std::uint64_t seed = 0; seed < 1500; ++seed) {
            try {
                const std::string damaged = mutate(bytes, seed);
                const PolygonSoup soup = read_memory(damaged);
                for (const Index corner : soup.corners) ASSERT_LT(corner, soup.points.size());
                for (const auto& point : soup.points)
                    for (const double x : point) ASSERT_TRUE(std::isfinite(x));
                const std::size_t faces = soup.polygon_count();
                ASSERT_TRUE(soup.extras.face_materials.empty() || soup.extras.face_materials.size() == faces);
                ASSERT_TRUE(soup.extras.corner_texture.empty() || soup.extras.corner_texture.size() == 3 * faces);
                ASSERT_TRUE(soup.extras.vertex_colours.empty() || soup.extras.vertex_colours.size() == soup.points.size());
                for (const Material& material : soup.extras.appearance.materials)
                    ASSERT_TRUE(material.image == no_index || material.image < soup.extras.appearance.images.size());
            } catch (const Error& error) {
                ++refused;
                EXPECT_FALSE(error.problem().empty());
            }
        }
        EXPECT_GT(refused, 0U);
        EXPECT_LT(refused, 1500U);
    }
}
