// Written data are read back to the bit if the format stores them; a note reports other data.
#include "io_examples.h"
#include "ostraka/core/error.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

TriangulatedSoup reread(const Path& file) { return triangulate(read_polygons(file)); }

std::vector<TriangleSoup> soups() {
    TriangleSoup triangle;
    triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.triangles = {{0, 1, 2}};
    TriangleSoup awkward = octahedron();  // extreme numbers, isolated vertices, a corner order that starts anywhere
    awkward.points[0] = {5e-324, -1.7976931348623157e308, 0.1};
    awkward.points[1] = {1e15 + 0.125, -1e-300, 1.0 / 3};
    awkward.points.push_back({7, 8, 9});
    for (auto& [a, b, c] : awkward.triangles) std::swap(a, b), std::swap(b, c);
    TriangleSoup fans = octahedron();  // not a manifold
    fans.triangles.push_back({0, 3, 2});
    return {triangle, octahedron(), uneven_torus(20, 31), awkward, fans};
}

}  // namespace

TEST(RoundTrip, PlyKeepsEverything) {
    const Scratch scratch;
    for (const auto& soup : soups())
        for (const Encoding encoding : {Encoding::binary, Encoding::ascii}) {
            const MeshExtras extras = full_extras(soup);
            EXPECT_TRUE(write_triangles(scratch / "a.ply", soup, extras, {encoding, "made by a\ntest"}).empty());
            const auto back = reread(scratch / "a.ply");
            EXPECT_EQ(back.soup.points, soup.points);
            EXPECT_EQ(back.soup.triangles, soup.triangles);
            EXPECT_TRUE(back.polygon_of_triangle.empty());
            EXPECT_EQ(back.extras.vertex_colours, extras.vertex_colours);
            EXPECT_EQ(back.extras.face_colours, extras.face_colours);
            EXPECT_EQ(back.extras.vertex_labels, extras.vertex_labels);
            EXPECT_EQ(back.extras.face_labels, extras.face_labels);
            EXPECT_EQ(back.extras.corner_texture, extras.corner_texture);
            expect_same_values(back.extras.vertex_values, extras.vertex_values);
            expect_same_values(back.extras.face_values, extras.face_values);
            EXPECT_TRUE(back.notes.empty());
            EXPECT_NE(read_file(scratch / "a.ply").find("comment made by a test\n"), std::string::npos);
        }
}

TEST(RoundTrip, PlyStoresValuesAndOtherFormatsReportTheLoss) {
    const Scratch scratch;
    const TriangleSoup soup = octahedron();
    const std::size_t count = soup.triangles.size();
    MeshExtras extras;
    extras.face_values = {{"distance", std::vector<double>(count, 0.25)},
                          {"two words", std::vector<double>(count, 0.1)},
                          {"unknown", std::vector<double>(count, std::nan(""))}};
    EXPECT_TRUE(write_triangles(scratch / "a.ply", soup, extras, {Encoding::ascii, {}}).empty());
    const std::string text = read_file(scratch / "a.ply");
    EXPECT_NE(text.find("property float distance\nproperty double two_words\nproperty float unknown\nend_header"),
              std::string::npos);
    EXPECT_NE(text.find(" 0.25 0.1 nan\n"), std::string::npos);
    extras.face_values[1].name = "two_words";
    expect_same_values(reread(scratch / "a.ply").extras.face_values, extras.face_values);
    EXPECT_EQ(write_triangles(scratch / "a.obj", soup, extras).size(), 1U);
    extras.face_values[0].values.pop_back();
    EXPECT_ANY_THROW(write_triangles(scratch / "a.ply", soup, extras));
}

TEST(RoundTrip, ObjKeepsGeometryColoursAndTexture) {
    const Scratch scratch;
    for (const auto& soup : soups())
        for (const bool has_seams : {false, true}) {
            MeshExtras extras = full_extras(soup);
            if (!has_seams) extras.corner_texture = texture_without_seams(soup);
            const auto notes = write_triangles(scratch / "a.obj", soup, extras);
            EXPECT_EQ(notes.size(), 4U);  // face colours, labels of vertices, labels of faces, values
            const auto back = reread(scratch / "a.obj");
            EXPECT_EQ(back.soup.points, soup.points);
            EXPECT_EQ(back.soup.triangles, soup.triangles);
            EXPECT_EQ(back.extras.vertex_colours, extras.vertex_colours);
            EXPECT_EQ(back.extras.corner_texture, extras.corner_texture);
            EXPECT_TRUE(back.extras.face_labels.empty());
        }
}

TEST(RoundTrip, OffKeepsGeometryColoursAndTexture) {
    const Scratch scratch;
    for (const auto& soup : soups()) {
        MeshExtras extras = full_extras(soup);
        extras.vertex_colours.front()[3] = 17;
        EXPECT_EQ(write_triangles(scratch / "a.off", soup, extras).size(), soup.triangles.size() == 1 ? 3U : 4U);
        extras.corner_texture = texture_without_seams(soup);
        EXPECT_EQ(write_triangles(scratch / "a.off", soup, extras).size(), 3U);  // labels twice, values
        const auto back = reread(scratch / "a.off");
        EXPECT_EQ(back.soup.points, soup.points);
        EXPECT_EQ(back.soup.triangles, soup.triangles);
        EXPECT_EQ(back.extras.vertex_colours, extras.vertex_colours);
        EXPECT_EQ(back.extras.face_colours, extras.face_colours);
        EXPECT_EQ(back.extras.corner_texture, extras.corner_texture);
        EXPECT_TRUE(write_triangles(scratch / "plain.off", soup).empty());
        EXPECT_EQ(reread(scratch / "plain.off").soup.points, soup.points);
    }
}

TEST(RoundTrip, StlKeepsSinglePrecision) {
    const Scratch scratch;
    const TriangleSoup soup = octahedron();
    for (const Encoding encoding : {Encoding::binary, Encoding::ascii}) {
        EXPECT_TRUE(write_triangles(scratch / "a.stl", soup, {}, {encoding, "solid"}).empty());
        const auto back = reread(scratch / "a.stl");
        EXPECT_EQ(back.soup.points, soup.points);
        EXPECT_EQ(back.soup.triangles, soup.triangles);
        EXPECT_EQ(write_triangles(scratch / "a.stl", soup, full_extras(soup), {encoding, {}}).size(),
                  4U);  // colours, labels, texture, values
        EXPECT_EQ(write_triangles(scratch / "b.stl", uneven_torus(5, 7), {}, {encoding, {}}).size(), 2U);  // rounded, renumbered
        const auto rounded = reread(scratch / "b.stl");
        EXPECT_EQ(rounded.soup.points.size(), 35U);
        EXPECT_EQ(rounded.soup.triangles.size(), 70U);
    }
}

TEST(RoundTrip, EveryFormatGivesTheSameChecksum) {
    const Scratch scratch;
    const TriangleSoup soup = uneven_torus(12, 9);
    const std::string checksum = mesh_checksum(build_mesh(soup));
    for (const char* name : {"a.ply", "a.obj", "a.off"}) {
        const Mesh mesh = build_mesh(soup);
        write_mesh(scratch / name, mesh);
        EXPECT_EQ(mesh_checksum(read_mesh(scratch / name).mesh), checksum) << name;
    }
}

TEST(RoundTrip, WritingTwiceGivesTheSameBytes) {
    const Scratch scratch;
    const TriangleSoup soup = uneven_torus(12, 9);
    for (const char* ending : {".ply", ".obj", ".off", ".stl", ".glb"}) {
        write_triangles(scratch / ("a" + std::string(ending)), soup, full_extras(soup));
        write_triangles(scratch / ("b" + std::string(ending)), soup, full_extras(soup));
        EXPECT_EQ(read_file(scratch / ("a" + std::string(ending))), read_file(scratch / ("b" + std::string(ending))));
    }
}
