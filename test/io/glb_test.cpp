// A GLB file's container, counts, bounds and bytes follow glTF 2.0.
#include "io_examples.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <cstring>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// The two chunks of a GLB file, its container checked.
struct Glb {
    Json json;
    std::string binary;

    explicit Glb(const Path& file) {
        const std::string bytes = read_file(file);
        const auto word = [&](std::size_t at) {
            std::uint32_t value = 0;
            std::memcpy(&value, bytes.data() + at, 4);
            return value;
        };
        EXPECT_EQ(bytes.substr(0, 4), "glTF");
        EXPECT_EQ(word(4), 2U);
        EXPECT_EQ(word(8), bytes.size());
        const std::size_t length = word(12);
        EXPECT_EQ(length % 4, 0U);
        EXPECT_EQ(bytes.substr(16, 4), "JSON");
        json = parse_json(bytes.substr(20, length), "glb");
        EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
        EXPECT_EQ(word(20 + length), bytes.size() - 28 - length);
        EXPECT_EQ(word(20 + length) % 4, 0U);
        binary = bytes.substr(28 + length);
        EXPECT_EQ(json["buffers"][0]["byteLength"].GetUint64(), binary.size());
    }
    [[nodiscard]] const JsonValue& primitive() const { return json["meshes"][0]["primitives"][0]; }
    [[nodiscard]] const JsonValue& attribute(const char* name) const {
        return json["accessors"][primitive()["attributes"][name].GetUint()];
    }

    template <class T>
    [[nodiscard]] std::vector<T> values(const JsonValue& accessor, std::size_t components) const {
        const auto& view = json["bufferViews"][accessor["bufferView"].GetUint()];
        std::vector<T> list(components * accessor["count"].GetUint64());
        EXPECT_EQ(view["byteLength"].GetUint64(), list.size() * sizeof(T));
        EXPECT_EQ(view["byteOffset"].GetUint64() % 4, 0U);
        EXPECT_LE(view["byteOffset"].GetUint64() + view["byteLength"].GetUint64(), binary.size());
        std::memcpy(list.data(), binary.data() + view["byteOffset"].GetUint64(), list.size() * sizeof(T));
        return list;
    }
};

}  // namespace

TEST(Glb, HoldsPositionsIndicesAndColours) {
    const Scratch scratch;
    TriangleSoup soup = octahedron();
    soup.points[2][2] = 1.5;
    MeshExtras extras;
    extras.vertex_colours.assign(6, {0, 255, 128, 255});
    EXPECT_TRUE(write_triangles(scratch / "a.glb", soup, extras, {Encoding::binary, "made \"here\""}).empty());
    const Glb glb(scratch / "a.glb");
    const auto positions = glb.values<float>(glb.attribute("POSITION"), 3);
    ASSERT_EQ(positions.size(), 18U);
    for (std::size_t i = 0; i < 18; ++i) EXPECT_EQ(positions[i], static_cast<float>(soup.points[i / 3][i % 3]));
    const auto& position = glb.attribute("POSITION");
    EXPECT_EQ(position["min"][2].GetDouble(), -1);
    EXPECT_EQ(position["max"][2].GetDouble(), 1.5);
    const auto indices = glb.values<std::uint32_t>(glb.json["accessors"][glb.primitive()["indices"].GetUint()], 1);
    ASSERT_EQ(indices.size(), 24U);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(indices[i], soup.triangles[i / 3][i % 3]);
    const auto colours = glb.values<std::uint16_t>(glb.attribute("COLOR_0"), 4);
    EXPECT_EQ(colours[0], 0);
    EXPECT_EQ(colours[1], 65535);
    EXPECT_NEAR(colours[2] / 65535.0, 0.2158605, 1e-5);  // sRGB 128 in linear light
    EXPECT_EQ(colours[3], 65535);
    EXPECT_TRUE(glb.attribute("COLOR_0")["normalized"].GetBool());
    EXPECT_STREQ(glb.json["asset"]["version"].GetString(), "2.0");
    EXPECT_STREQ(glb.json["asset"]["extras"]["provenance"].GetString(), "made \"here\"");
}

TEST(Glb, FaceColoursSplitTheVertices) {
    const Scratch scratch;
    MeshExtras extras = full_extras(octahedron());
    extras.vertex_colours.clear();
    extras.vertex_values.clear();
    extras.face_values.clear();
    const auto notes = write_triangles(scratch / "a.glb", octahedron(), extras);
    EXPECT_EQ(notes.size(), 2U);  // split, labels
    const Glb glb(scratch / "a.glb");
    EXPECT_EQ(glb.attribute("POSITION")["count"].GetInt(), 24);
    const auto colours = glb.values<std::uint16_t>(glb.attribute("COLOR_0"), 4);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(colours[4 * i + 3], 257 * extras.face_colours[i / 3][3]);
    const auto texture = glb.values<float>(glb.attribute("TEXCOORD_0"), 2);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(texture[2 * i], extras.corner_texture[i][0]);
    EXPECT_STREQ(glb.json["materials"][0]["alphaMode"].GetString(), "BLEND");
}

TEST(Glb, UnsupportedDataIsRefusedOrReported) {
    const Scratch scratch;
    TriangleSoup soup = octahedron();
    soup.points[0][0] = 0.1;
    EXPECT_EQ(write_triangles(scratch / "a.glb", soup).size(), 1U);  // rounded
    soup.points[0][0] = 1e39;
    EXPECT_THROW(write_triangles(scratch / "b.glb", soup), Error);
    EXPECT_THROW(write_triangles(scratch / "b.stl", soup), Error);
    soup.triangles.clear();
    EXPECT_THROW(write_triangles(scratch / "b.glb", soup), Error);
    soup.triangles = {{0, 1, 6}};
    EXPECT_THROW(write_triangles(scratch / "b.ply", soup), Error);
    MeshExtras extras;
    extras.face_labels = {1, 2, 3};
    EXPECT_THROW(write_triangles(scratch / "b.ply", octahedron(), extras), std::logic_error);
    EXPECT_THROW(write_triangles(scratch / "b.vrml", octahedron()), Error);
    EXPECT_EQ(count_files(scratch.path()), 1U);
}
