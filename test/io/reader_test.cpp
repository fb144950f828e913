// Known contents of each format, and the messages of refusals.
#include "io_examples.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_of_polygons.h"
#include "ostraka/io/ply.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <cstring>
#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

PolygonSoup read(const std::string& name, const std::string& bytes) {
    const Scratch scratch;
    return read_polygons(scratch.file(name, bytes));
}

/// The message of the refusal; empty if the file was read.
std::string refusal(const std::string& name, const std::string& bytes) {
    try {
        read(name, bytes);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        return error.what();
    }
    return {};
}

testing::AssertionResult has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos ? testing::AssertionSuccess()
                                                : testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

bool has_note(const std::vector<std::string>& notes, const std::string& part) {
    for (const auto& note : notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

using Corners = std::vector<Index>;
using Points = std::vector<std::array<double, 3>>;

const std::string obj_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string ply_xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string ply_faces = "property list uchar int vertex_indices\n";

}  // namespace

TEST(Obj, IndicesCountForwardBackwardAndAhead) {
    const auto soup = read("a.obj", "f 1 2 3\n" + obj_square + "f -4 -3/ -2//\nf 1/1/1 2//5 \\\n 4\nvt 0 0\n# f 9 9 9\n");
    EXPECT_EQ(soup.corners, (Corners{0, 1, 2, 0, 1, 2, 0, 1, 3}));
    EXPECT_EQ(soup.polygon_begin, (Corners{0, 3, 6, 9}));
}

TEST(Obj, NumbersInAllTheirForms) {
    const auto soup =
        read("a.obj", "\xEF\xBB\xBFv +1 2. .5\r\nv -1e-2 1E2 1e-400\r\nv 0.1 5e-324 123456789012345678901234567890\r\n");
    EXPECT_EQ(soup.points, (Points{{1, 2, 0.5}, {-0.01, 100, 0}, {0.1, 5e-324, 123456789012345678901234567890.0}}));
    for (const char* number : {"nan", "inf", "-infinity", "1e400", "0x10", "1e", "1.5.2", "--1", "+-1", "", "1,5", "\x01"}) {
        const std::string message = refusal("a.obj", "v 0 0 0\nv 0 0 " + std::string(number) + "\n");
        EXPECT_TRUE(has(message, "line 2")) << number;
    }
}

TEST(Obj, ColoursInUnitsOrBytes) {
    const auto unit = read("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 1 0.2\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(unit.extras.vertex_colours, (std::vector<Colour>{{255, 128, 0, 255}, {0, 0, 255, 51}, {255, 255, 255, 255}}));
    EXPECT_TRUE(has_note(unit.notes, "1 vertices have no colour"));
    const auto bytes = read("a.obj", "v 0 0 0 255 100 0\nf 1 1 1\n");
    EXPECT_EQ(bytes.extras.vertex_colours, (std::vector<Colour>{{255, 100, 0, 255}}));
    EXPECT_TRUE(has_note(read("a.obj", "v 0 0 0 nan 0 0\nf 1 1 1\n").notes, "out of range"));
    EXPECT_TRUE(has_note(read("a.obj", "v 0 0 0 2\nf 1 1 1\n").notes, "weight"));
}

TEST(Obj, OpacityThatIsNoNumberIsReported) {
    const auto soup = read("a.obj", "v 0 0 0 1 0 0 0.5\nv 1 0 0 0 1 0 word\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(soup.extras.vertex_colours, (std::vector<Colour>{{255, 0, 0, 128}, {0, 255, 0, 255}, {255, 255, 255, 255}}));
    EXPECT_TRUE(has_note(soup.notes, "1 vertices have an opacity that is not a number"));
}

TEST(Obj, ALastFaceWithoutLineEndIsReported) {
    EXPECT_TRUE(has_note(read("a.obj", obj_square + "f 1 2 3\nf 1 3 4").notes, "cut off in its last face"));
    EXPECT_FALSE(has_note(read("a.obj", obj_square + "f 1 2 3\nf 1 3 4\n").notes, "cut off"));
    EXPECT_FALSE(has_note(read("a.obj", obj_square + "f 1 2 3\n# end").notes, "cut off"));
}

TEST(Obj, RefusalsNameTheLine) {
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "f 1 2 0\n"), "line 5"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "f 1 2 3\nf 1 2 5\nf 2 3 4\n"), "line 6: a face names vertex 5 of 4"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "f 1 2 -5\n"), "vertex -5 of 4"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "f 1 2 99999999999\n"), "99999999999"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "f 1 2 3x\n"), "'3x'"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "f 1/1 2/1 3/1\n"), "texture coordinate 1 of 0"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "w 1 2 3\n"), "unknown statement 'w'"));
    EXPECT_TRUE(has(refusal("a.obj", obj_square + "v 1 2\n"), "line 5"));
    EXPECT_TRUE(has(refusal("a.obj", "v 1 2 3 4 5\n"), "five numbers"));
    EXPECT_TRUE(has(refusal("a.obj", "v 0 0 0 \\\n\\\nf 1 1\nf 2 2 2\n"), "line 3"));  // continued lines still count
}

TEST(Obj, ShortFacesAreReadAndGiveNoTriangle) {
    auto soup = read("a.obj", obj_square + "f 1 2\nf\nf 1 1 2\nf 1 2 3\nl 1 2\ng x\n");
    EXPECT_EQ(soup.polygon_count(), 4U);
    EXPECT_TRUE(has_note(soup.notes, "g, l"));
    const auto triangles = triangulate(std::move(soup));
    EXPECT_EQ(triangles.soup.triangles.size(), 1U);
    EXPECT_EQ(triangles.polygon_of_triangle, (Corners{3}));
    EXPECT_TRUE(has_note(triangles.notes, "3 faces have fewer than three"));
}

TEST(Ply, PropertiesAndElementsInAnyOrder) {
    const auto soup =
        read("a.ply",
             "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement camera 1\r\nproperty list uchar float view\r\nproperty float f\r\n"
             "element face 2\r\nproperty float quality\r\nproperty list int uint vertex_index\r\nproperty uchar red\r\nproperty "
             "uchar green\r\nproperty uchar blue\r\nproperty short part_label\r\n"
             "element vertex 4\r\nproperty int z\r\nproperty double x\r\nproperty list uchar int neighbours\r\nproperty float "
             "y\r\nproperty float red\r\nproperty float green\r\nproperty float blue\r\nproperty uint label\r\nend_header\r\n"
             "2 0.5 nan 7\r\n\r\n0.25 3 0 1 2 10 20 30 -5\r\n9 4 0 1 2 3 1 2 3 6\r\n1 0.1 0 2 1 0 0.5 4294967295\r\n0 1 1 7 0 0 "
             "0 0 3\r\n0 1 0 1 0 0 0 4\r\n0 0 0 1 0 0 0 5\r\n");
    EXPECT_EQ(soup.points, (Points{{0.1, 2, 1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(soup.corners, (Corners{0, 1, 2, 0, 1, 2, 3}));
    EXPECT_EQ(soup.extras.face_colours, (std::vector<Colour>{{10, 20, 30, 255}, {1, 2, 3, 255}}));
    EXPECT_EQ(soup.extras.face_labels, (std::vector<std::int32_t>{-5, 6}));
    EXPECT_EQ(soup.extras.vertex_labels, (std::vector<std::int32_t>{-1, 3, 4, 5}));
    EXPECT_EQ(soup.extras.vertex_colours.front(), (Colour{255, 0, 128, 255}));
    EXPECT_TRUE(has_note(soup.notes, "element not kept: camera"));
    EXPECT_TRUE(has_note(soup.notes, "vertex properties not kept: neighbours"));
    ASSERT_EQ(soup.extras.face_values.size(), 1U);
    EXPECT_EQ(soup.extras.face_values[0].name, "quality");
    EXPECT_EQ(soup.extras.face_values[0].values, (std::vector<double>{0.25, 9}));
    EXPECT_TRUE(has_note(soup.notes, "1 labels above"));
}

TEST(Ply, BigEndianEqualsLittleEndian) {
    const std::string header =
        " 1.0\nelement vertex 3\nproperty double x\nproperty short y\nproperty float z\nelement face 1\nproperty list ushort "
        "uint vertex_indices\nend_header\n";
    std::string little, big;
    const auto put = [&](const auto value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        little.append(bytes, sizeof value);
        std::reverse(bytes, bytes + sizeof value);
        big.append(bytes, sizeof value);
    };
    for (int v = 0; v < 3; ++v) {
        put(0.1 * v);
        put(static_cast<std::int16_t>(-300 * v * v));
        put(1.5F * static_cast<float>(v));
    }
    put(std::uint16_t{3});
    for (const std::uint32_t v : {2U, 0U, 1U}) put(v);
    const auto a = read("a.ply", "ply\nformat binary_little_endian" + header + little),
               b = read("b.ply", "ply\nformat binary_big_endian" + header + big);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_EQ(a.corners, (Corners{2, 0, 1}));
    EXPECT_EQ(a.points[2], (std::array<double, 3>{0.2, -1200, 3}));
}

TEST(Ply, StripsBecomeTriangles) {
    const auto soup = read("a.ply", "ply\nformat ascii 1.0\nelement vertex 5\n" + ply_xyz +
                                        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 "
                                        "1 0\n1 1 0\n0 2 0\n10 0 1 2 3 -1 2 3 4 4 1\n");
    EXPECT_EQ(soup.corners, (Corners{0, 1, 2, 2, 1, 3, 2, 3, 4}));
}

TEST(Ply, VectorsOfTheVertices) {
    const Scratch scratch;
    const std::string start = "ply\nformat ascii 1.0\n", normals = "property float nx\nproperty double ny\nproperty float nz\n";
    using Vectors = std::vector<std::array<double, 3>>;
    const auto vectors = [&](const std::string& bytes) {
        return read_ply_vectors(scratch.file("a.ply", bytes), {"nx", "ny", "nz"});
    };
    EXPECT_EQ(vectors(start + "element other 1\nproperty list int int list\nelement vertex 2\n" + normals +
                      "property list int int more\n" + ply_xyz + "end_header\n2 7 8\n1 0 0.5 0 1 2 3\n0 1 2 1 9 1 2 3\n"),
              (Vectors{{1, 0, 0.5}, {0, 1, 2}}));
    EXPECT_EQ(vectors(start + "element vertex 1\n" + ply_xyz + "end_header\n1 2 3\n"), Vectors{});
    EXPECT_EQ(vectors(start + "element vertex 1\n" + ply_xyz + "property int nx\nproperty int ny\nproperty int nz\nend_header\n" +
                      "1 2 3 0 0 1\n"),
              Vectors{})
        << "whole numbers are no normals";
    EXPECT_EQ(vectors("OFF\n0 0 0\n"), Vectors{});
    EXPECT_THROW(vectors(start + "element vertex 2\n" + normals + "end_header\n1 0 0\n0 x 0\n"), Error);
}

TEST(Ply, FalseHeadersAreRefusedBeforeAllocation) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        const std::string start = std::string("ply\nformat ") + format + " 1.0\n";
        EXPECT_TRUE(has(refusal("a.ply", start + "element vertex 1000000000\n" + ply_xyz + "end_header\n0 0 0\n"), "1000000000"));
        EXPECT_TRUE(has(
            refusal("a.ply", start + "element vertex 0\n" + ply_xyz + "element face 1000000000\n" + ply_faces + "end_header\n"),
            "1000000000"));
        EXPECT_TRUE(
            has(refusal("a.ply", start + "element vertex 9223372036854775807\n" + ply_xyz + "end_header\n0 0 0\n"), "promises"));
        EXPECT_TRUE(has(refusal("a.ply", start + "element vertex 99999999999999999999\n" + ply_xyz + "end_header\n"), "line 3"));
    }
    std::string list = "ply\nformat binary_little_endian 1.0\nelement vertex 0\n" + ply_xyz +
                       "element face 1\nproperty list uint int vertex_indices\nend_header\n";
    EXPECT_TRUE(has(refusal("a.ply", list + std::string(4, '\xff')), "claims 4294967295 entries"));
}

TEST(Ply, RefusalsNameLineOrByte) {
    const std::string start = "ply\nformat ascii 1.0\n", vertices = start + "element vertex 3\n" + ply_xyz,
                      faces = vertices + "element face 1\n" + ply_faces + "end_header\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(refusal("a.ply", faces + "3 0 1 2\n"), "");
    EXPECT_TRUE(has(refusal("a.ply", faces + "3 0 1 3\n"), "line 13: face 0 names vertex 3 of 3"));
    EXPECT_TRUE(has(refusal("a.ply", faces + "3 0 1 -1\n"), "vertex -1 of 3"));
    EXPECT_TRUE(has(refusal("a.ply", faces + "3 0 1\n"), "line 13"));
    EXPECT_TRUE(has(refusal("a.ply", faces + "3 0 1 2 0\n"), "more values"));
    EXPECT_TRUE(has(refusal("a.ply", faces + "-1\n"), "claims -1"));
    EXPECT_TRUE(has(refusal("a.ply", faces), "ends at face 0 of 1"));
    const std::string nan_vertex = vertices + "element face 1\n" + ply_faces + "end_header\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_TRUE(has(refusal("a.ply", nan_vertex), "vertex 1 has a coordinate that is not finite, and faces use it"));
    EXPECT_TRUE(has(refusal("a.ply", start + "element vertex 1\nproperty float x\nend_header\n0\n"), "x, y and z"));
    EXPECT_TRUE(has(refusal("a.ply", vertices), "end_header"));
    EXPECT_TRUE(has(refusal("a.ply", "ply\nelement vertex 0\nend_header\n"), "no format"));
    EXPECT_TRUE(has(refusal("a.ply", "ply\nformat text 1.0\n"), "unknown format 'text'"));
    EXPECT_TRUE(has(refusal("a.ply", start + "element vertex 0\nproperty quaternion x\n"), "unknown property type"));
    EXPECT_TRUE(has(refusal("a.ply", start + "property float x\n"), "before the first element"));
    EXPECT_TRUE(has(refusal("a.ply", start + "wobble\n"), "unknown header line 'wobble'"));
    EXPECT_TRUE(has(refusal("a.ply", start + "element vertex 0\nelement vertex 0\n"), "declared twice"));
    const std::string binary = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + ply_xyz + "end_header\n";
    EXPECT_TRUE(has(refusal("a.ply", binary + std::string(11, '\0')), "cut off"));
}

TEST(Ply, UnusedVerticesWithoutCoordinatesAreDropped) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 5\n" + ply_xyz + "property uchar red\nproperty uchar green\n" +
        "property uchar blue\nproperty int part_label\nproperty float age\nelement face 1\n" + ply_faces + "end_header\n";
    const auto soup = read("a.ply", header +
                                        "nan 0 0 1 1 1 1 1\n0 0 0 2 2 2 2 2\n1 0 0 3 3 3 3 3\n0 inf 0 4 4 4 4 4\n"
                                        "0 1 0 5 5 5 5 5\n3 1 2 4\n");
    EXPECT_EQ(soup.points, (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(soup.corners, (Corners{0, 1, 2}));
    EXPECT_EQ(soup.vertex_of_file_vertex, (Corners{no_index, 0, 1, no_index, 2}));
    EXPECT_EQ(soup.extras.vertex_labels, (std::vector<std::int32_t>{2, 3, 5}));
    EXPECT_EQ(soup.extras.vertex_colours[2], (Colour{5, 5, 5, 255}));
    EXPECT_EQ(soup.extras.vertex_values[0].values, (std::vector<double>{2, 3, 5}));
    EXPECT_TRUE(has_note(soup.notes, "2 vertices that no face uses"));
}

TEST(Text, MayBeginWithAByteOrderMark) {
    const std::string mark = "\xEF\xBB\xBF";
    EXPECT_EQ(read("a.ply", mark + "ply\nformat ascii 1.0\nelement vertex 1\n" + ply_xyz + "end_header\n1 2 3\n").points,
              (Points{{1, 2, 3}}));
    EXPECT_EQ(read("a.stl", mark + "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                                   "endfacet\nendsolid x\n")
                  .polygon_count(),
              1U);
    EXPECT_EQ(read("a.off", mark + "OFF\n1 0 0\n1 2 3\n").points, (Points{{1, 2, 3}}));
    const Scratch scratch;
    write_triangles(scratch / "a.stl", octahedron());
    EXPECT_EQ(read("b.stl", mark + read_file(scratch / "a.stl")).polygon_count(), 8U);
}

TEST(Off, HeaderInItsForms) {
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const std::string header : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "# c\n\nOFF # c\n# c\n3 1\n", "3 1 3\n", "OFF\r\n3 1 0\r\n",
                                     "OFF3 1 0\n", "off 3 1\n", "OFF3 # c\n# c\n\n1 0 # c\n"}) {
        const auto soup = read("a.off", header + body);
        EXPECT_EQ(soup.points, (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << header;
        EXPECT_EQ(soup.corners, (Corners{0, 1, 2})) << header;
    }
    const auto one_line = read("a.off", "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2");
    EXPECT_EQ(one_line.corners, (Corners{0, 1, 2}));
}

TEST(Off, ColoursNormalsAndTexture) {
    const auto full = read("a.off",
                           "STCNOFF\n3 2 0\n0 0 0 0 0 1 255 0 0 255 0.5 0.25\n1 0 0 0 0 1 0 1.0 0 0 1\n0 1 0 0 0 1 7 8 9 1 1\n3 "
                           "0 1 2 0.5 1.0 0\n3 0 2 1 10 20 30 40\n");
    EXPECT_EQ(full.points[2], (std::array<double, 3>{0, 1, 0}));
    EXPECT_EQ(full.extras.vertex_colours, (std::vector<Colour>{{255, 0, 0, 255}, {0, 255, 0, 255}, {7, 8, 9, 255}}));
    EXPECT_EQ(full.extras.corner_texture,
              (std::vector<TexturePoint>{{0.5F, 0.25F}, {0, 1}, {1, 1}, {0.5F, 0.25F}, {1, 1}, {0, 1}}));
    EXPECT_EQ(full.extras.face_colours, (std::vector<Colour>{{128, 255, 0, 255}, {10, 20, 30, 40}}));
    const auto undeclared = read("a.off", "OFF\n3 2 0\n0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n3 0 1 2\n3 0 2 1 5\n");
    EXPECT_EQ(undeclared.extras.vertex_colours[2], (Colour{7, 8, 9, 255}));
    EXPECT_TRUE(has_note(undeclared.notes, "palette"));
}

TEST(Off, KeywordAndCountsOnOneLine) {
    for (const std::string header : {"COFF 3 1 0\n", "COFF3 1 0\n", "COFF # c\n 3 1 # c\n# c\n"})
        EXPECT_EQ(read("a.off", header + "0 0 0 255 0 0\n# c\n1 0 0 0 255 0\n0 1 0 7 8 9\n3 0 1 2\n").extras.vertex_colours,
                  (std::vector<Colour>{{255, 0, 0, 255}, {0, 255, 0, 255}, {7, 8, 9, 255}}))
            << header;
    for (const std::string header : {"NOFF 3 1 0\n", "NOFF3 1 0\n", "# c\nNOFF\n# c\n3 1 0\n"})
        EXPECT_EQ(read("a.off", header + "0 0 0 0 0 1\n1 0 0 0 0 1 # c\n0 1 0 0 0 1\n3 0 1 2\n").points,
                  (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}))
            << header;
    EXPECT_TRUE(has(refusal("a.off", "OFFset 1\n"), "OFFset"));
}

TEST(Text, InUtf16NamesTheCommandThatConverts) {
    const std::string text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    std::string little, big;
    for (const char c : text) little += {c, '\0'}, big += {'\0', c};
    for (const std::string& bytes : {"\xFF\xFE" + little, "\xFE\xFF" + big, little, big})
        for (const char* file : {"a.off", "a.obj", "a.ply", "a.stl"}) {
            const std::string message = refusal(file, bytes);
            EXPECT_TRUE(has(message, "UTF-16: convert to UTF-8")) << message;
            EXPECT_TRUE(has(message, "iconv -f UTF-16")) << message;
        }
}

TEST(Off, RefusalsNameTheLine) {
    EXPECT_TRUE(has(refusal("a.off", "OFF\n2000000000 2000000000 0\n0 0 0\n"), "promises"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n-3 1 0\n"), "negative"));
    EXPECT_TRUE(has(refusal("a.off", "OFF BINARY\n"), "binary OFF"));
    EXPECT_TRUE(has(refusal("a.off", "4OFF\n1 0 0\n0 0 0 0\n"), "4OFF"));
    EXPECT_TRUE(has(refusal("a.off", "hello\n"), "hello"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n"), "line 4: face 0 names vertex 1 of 1"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n1 1 0\n0 0 0\n1000000 0 0 0\n"), "promises 1000000 corners"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n1 2 0\n0 0 0\n3 0 0 0\n"), "ends at face 1 of 2"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 0 1 2 3 4 5\n"), "more than a colour"));
}

TEST(Stl, SizeDecidesNotTheFirstWord) {
    const Scratch scratch;
    write_triangles(scratch / "a.stl", octahedron());
    std::string bytes = read_file(scratch / "a.stl");
    bytes.replace(0, 5, "solid");
    EXPECT_EQ(read("a.stl", bytes).polygon_count(), 8U);
    bytes[84 + 48] = 1;
    EXPECT_TRUE(has_note(read("a.stl", bytes).notes, "attribute"));
    EXPECT_TRUE(read("a.stl", bytes).extras.face_colours.empty());
    EXPECT_TRUE(has_note(read("a.stl", bytes + "tail").notes, "last triangle"));
    EXPECT_TRUE(has(refusal("a.stl", bytes.substr(0, 300)), "room for 4"));
    EXPECT_TRUE(has(refusal("a.stl", bytes.substr(0, 50)), "STL"));
    std::memset(&bytes[84 + 50 + 12], 0xff, 4);
    EXPECT_TRUE(has(refusal("a.stl", bytes), "triangle 1"));
}

TEST(Stl, CountsThatAreTooSmallAreCorrected) {
    const Scratch scratch;
    write_triangles(scratch / "a.stl", octahedron());
    std::string bytes = read_file(scratch / "a.stl");
    for (const std::uint32_t count : {0U, 3U, 7U}) {
        std::memcpy(&bytes[80], &count, 4);
        const auto soup = read("a.stl", bytes);
        EXPECT_EQ(soup.polygon_count(), 8U) << count;
        EXPECT_TRUE(has_note(soup.notes, "but the file has 8"));
    }
    // Bytes that are no triangles are not read as such.
    EXPECT_TRUE(has_note(read("a.stl", bytes.substr(0, 84 + 7 * 50) + std::string(50, '\0')).notes, "50 bytes after"));
    EXPECT_EQ(read("a.stl", bytes.substr(0, 84 + 7 * 50) + std::string(50, '\xff')).polygon_count(), 7U);
}

TEST(Stl, ColoursOfTriangles) {
    const Scratch scratch;
    write_triangles(scratch / "a.stl", octahedron());
    const std::string plain = read_file(scratch / "a.stl");
    const auto set = [](std::string& bytes, std::size_t facet, std::uint16_t attribute) {
        std::memcpy(&bytes[84 + 50 * facet + 48], &attribute, 2);
    };
    std::string marked = plain;  // VisCAM: the highest bit, then red, green, blue
    set(marked, 0, 0x8000U | (31U << 10) | (16U << 5));
    set(marked, 1, 0x8000U | 31U);
    const auto viscam = read("a.stl", marked);
    ASSERT_EQ(viscam.extras.face_colours.size(), 8U);
    EXPECT_EQ(viscam.extras.face_colours[0], (Colour{255, 132, 0, 255}));
    EXPECT_EQ(viscam.extras.face_colours[1], (Colour{0, 0, 255, 255}));
    EXPECT_EQ(viscam.extras.face_colours[2], (Colour{255, 255, 255, 255}));
    EXPECT_TRUE(has_note(viscam.notes, "6 triangles have no colour"));
    std::string magics = plain;  // Magics: the colour of the object in the header, and blue, green, red of the others
    magics.replace(10, 10, std::string("COLOR=\x0a\x14\x1e\xff", 10));
    EXPECT_EQ(read("a.stl", magics).extras.face_colours, std::vector<Colour>(8, Colour{10, 20, 30, 255}));
    set(magics, 0, 31U);
    set(magics, 1, 0x8000U);
    const auto coloured = read("a.stl", magics);
    EXPECT_EQ(coloured.extras.face_colours[0], (Colour{255, 0, 0, 255}));
    EXPECT_EQ(coloured.extras.face_colours[1], (Colour{10, 20, 30, 255}));
    EXPECT_EQ(coloured.extras.face_colours[2], (Colour{0, 0, 0, 255}));
}

TEST(Stl, TextWithSeveralSolids) {
    const std::string facet =
        "FACET NORMAL nan nan nan\n OUTER LOOP\n VERTEX 0 0 0\n vertex 1 0 -0\n vertex 0 1e0 0\n ENDLOOP\n ENDFACET\n";
    const std::string other = "facet normal 0 0 1 outer loop vertex -0 0 0 vertex 0 1 0 vertex 1 0 0 endloop endfacet\n";
    const auto soup = read("a.stl", "solid one facet\n" + facet + "endsolid one facet\nsolid\n" + other + "endsolid");
    EXPECT_EQ(soup.corners, (Corners{0, 1, 2, 0, 2, 1}));  // negative zero is zero
    EXPECT_TRUE(has(refusal("a.stl", "solid\n" + facet), "endsolid"));
    EXPECT_TRUE(has(refusal("a.stl", "solid\n" + facet.substr(0, 60)), "cut off"));
    EXPECT_TRUE(has(refusal("a.stl", "solid\n" + facet + "hello\n"), "line 9: unexpected word 'hello'"));
    EXPECT_TRUE(has(refusal("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n"), "line 4"));
}

TEST(ReadPolygons, ContentWinsOverAWrongExtension) {
    const Scratch scratch;
    write_triangles(scratch / "a.ply", octahedron());
    std::filesystem::rename(scratch / "a.ply", scratch / "a.STL");
    const auto soup = read_polygons(scratch / "a.STL");
    EXPECT_EQ(soup.points, octahedron().points);
    EXPECT_TRUE(has_note(soup.notes, "contains PLY"));
}

TEST(ReadPolygons, OtherFilesAreRefused) {
    const Scratch scratch;
    EXPECT_TRUE(has(refusal("a.obj", ""), "is empty"));
    EXPECT_THROW(read_polygons(scratch / "missing.ply"), Error);
    std::filesystem::create_directory(scratch / "folder.ply");
    EXPECT_THROW(read_polygons(scratch / "folder.ply"), Error);
    try {
        read_polygons(scratch.file("a.xyz", "0 0 0\n"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
}

TEST(ReadMesh, SizesBeyondNumbersAreRefused) {
    const Scratch scratch;
    const auto message = [&](const std::string& obj) {
        try {
            read_mesh(scratch.file("a.obj", obj));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    for (const char* at : {"1 1 1", "0 0 0", "1e-80 0 0"})
        EXPECT_TRUE(has(message(std::string("v ") + at + "\nv " + at + "\nv " + at + "\nf 1 2 3\n"), "has no extent")) << at;
    for (const char* unit : {"e-80", "e-200", "e70"})
        EXPECT_TRUE(has(message(std::string("v 0 0 0\nv 1") + unit + " 0 0\nv 0 1" + unit + " 0\nf 1 2 3\n"), "1e-60 to 1e60"))
            << unit;
    EXPECT_EQ(message("v 0 0 0\nv 1e-50 0 0\nv 0 1e-50 0\nf 1 2 3\n"), "");
}

TEST(ReadMesh, MakesEverySurfaceAnOrientedManifold) {
    const Scratch scratch;
    const auto message = [&](const std::string& obj) {
        try {
            read_mesh(scratch.file("a.obj", obj));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message(obj_square + "f 1 2 3 4\n"), "");
    EXPECT_TRUE(has(message(obj_square), "has no faces"));
    EXPECT_TRUE(has(message(obj_square + "f 1 2\n"), "three distinct corners"));
    const auto read = [&](const std::string& obj) { return read_mesh(scratch.file("a.obj", obj)); };
    const auto note = [](const MeshFile& file) { return manifold_notes(file).empty() ? std::string() : manifold_notes(file)[0]; };
    EXPECT_EQ(note(read(obj_square + "f 1 2 3 4\n")), "");
    // Three triangles at an edge: none is lost, and their numbers are those of the file.
    const MeshFile fan = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    EXPECT_EQ(fan.mesh.number_of_faces(), 3U);
    EXPECT_EQ(fan.mesh.number_of_vertices(), 7U) << "the ends of the edge, once more";
    EXPECT_EQ(fan.mesh.point(Vertex(5)), fan.mesh.point(Vertex(fan.mesh.point(Vertex(5)) == Point(0, 0, 0) ? 0 : 1)));
    EXPECT_TRUE(has(note(fan), "1 edges with more than two triangles"));
    EXPECT_TRUE(has(note(fan), "2 copies of vertices"));
    for (std::size_t t = 0; t < 3; ++t) {
        const auto vertices = corners(fan.mesh, Face(static_cast<Index>(t)));
        EXPECT_EQ(
            std::count_if(vertices.begin(), vertices.end(), [&](Vertex v) { return v == Vertex(static_cast<Index>(t + 2)); }), 1)
            << "the third corner of triangle " << t;
    }
    // A triangle given twice, once turned over.
    const MeshFile twice = read(obj_square + "f 1 2 3\nf 1 3 4\nf 1 3 2\n");
    EXPECT_EQ(twice.mesh.number_of_faces(), 3U);
    // A triangle that is oriented differently from its two neighbours.
    const MeshFile turned = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\nf 1 2 3\nf 1 4 3\nf 2 5 3\n");
    EXPECT_EQ(turned.mesh.number_of_vertices(), 5U);
    EXPECT_TRUE(has(note(turned), "1 triangles were turned over")) << note(turned);
    for (const Face face : turned.mesh.faces()) EXPECT_GT(area_vector(turned.mesh, face).z(), 0);
    // Two sheets that touch in a vertex.
    const MeshFile touching = read(obj_square + "v 2 2 0\nv 2 1.5 0\nf 1 2 3\nf 3 6 5\n");
    EXPECT_EQ(touching.mesh.number_of_vertices(), 7U);
    EXPECT_TRUE(has(note(touching), "several sheets"));
    const auto mesh = read_mesh(scratch.file("b.obj", "v 9 9 9\n" + obj_square + "f 2 3 4 5\n"));
    EXPECT_EQ(mesh.mesh.number_of_vertices(), 5U);  // the isolated vertex stays
    EXPECT_EQ(mesh.polygon_of_triangle, (Corners{0, 0}));
}

TEST(ReadMesh, KeepsTrianglesOfAnyComplexWithTheirAttributes) {
    // Random triangles on few vertices: nearly every edge has many triangles, and every vertex many sheets.
    std::mt19937 random(7);
    for (int round = 0; round < 60; ++round) {
        const std::uint32_t vertex_count = 4 + random() % 9, face_count = 1 + random() % 60;
        PolygonSoup soup;
        for (std::uint32_t v = 0; v < vertex_count; ++v) {
            soup.points.push_back({std::cos(2.0 * v), std::sin(2.0 * v), 0.1 * v});
            soup.extras.vertex_labels.push_back(static_cast<std::int32_t>(v));
        }
        for (std::uint32_t f = 0; f < face_count; ++f) {
            const std::uint32_t a = random() % vertex_count, b = (a + 1 + random() % (vertex_count - 1)) % vertex_count;
            std::uint32_t c = random() % vertex_count;
            while (c == a || c == b) c = (c + 1) % vertex_count;
            for (const std::uint32_t v : {a, b, c}) {
                soup.corners.push_back(v);
                soup.extras.corner_texture.push_back({static_cast<float>(v), static_cast<float>(f)});
            }
            soup.polygon_begin.push_back(static_cast<Index>(soup.corners.size()));
        }
        const PolygonSoup original = soup;
        const MeshFile file = mesh_of_polygons(std::move(soup), "random");
        ASSERT_EQ(file.mesh.number_of_faces(), face_count);
        ASSERT_TRUE(file.mesh.is_valid(false));
        for (const Face face : file.mesh.faces()) {
            const auto vertices = corners(file.mesh, face);
            std::array<Index, 3> labels{}, expected{};
            for (std::size_t k = 0; k < 3; ++k) {
                labels[k] = static_cast<Index>(file.extras.vertex_labels[vertices[k]]);
                expected[k] = original.corners[3 * static_cast<std::size_t>(face) + k];
                const TexturePoint texture = file.extras.corner_texture[3 * static_cast<std::size_t>(face) + k];
                EXPECT_EQ(texture, (TexturePoint{static_cast<float>(labels[k]), static_cast<float>(face)}));
                const auto& at = original.points[labels[k]];
                EXPECT_EQ(file.mesh.point(vertices[k]), Point(at[0], at[1], at[2]));
            }
            std::sort(labels.begin(), labels.end());
            std::sort(expected.begin(), expected.end());
            EXPECT_EQ(labels, expected);
        }
        for (std::uint32_t v = 0; v < vertex_count; ++v)
            EXPECT_EQ(file.extras.vertex_labels[v], static_cast<std::int32_t>(v)) << "vertices keep their numbers";
    }
}

TEST(ReadMesh, NamesAConverterForOtherFormats) {
    const Scratch scratch;
    for (const auto& [name, format, remedy] : {std::tuple{"a.dae", "COLLADA", "assimp export"},
                                               {"a.x3d", "X3D", "assimp"},
                                               {"a.FBX", "FBX", "assimp"},
                                               {"a.wrl", "VRML", "MeshLab"},
                                               {"a.blend", "Blender", "Blender"},
                                               {"a.usdz", "USD", "Blender"}}) {
        try {
            read_polygons(scratch.file(name, "<x/>"));
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_TRUE(has(error.what(), format)) << error.what();
            EXPECT_TRUE(has(error.what(), remedy)) << error.what();
        }
    }
}

TEST(ReadPolygons, EveryDefectiveFileIsReadOrRefusedWithAMessage) {
    const Path data = OSTRAKA_SHARED_DATA;
    if (!std::filesystem::is_directory(data / "broken")) GTEST_SKIP() << "no " << data;
    std::size_t files = 0, refused = 0;
    for (const char* folder : {"broken", "broken-synthetic"})
        for (const auto& entry : std::filesystem::directory_iterator(data / folder)) {
            if (entry.path().extension() == ".txt") continue;
            ++files;
            try {
                Mesh mesh;
                try_build_mesh(triangulate(read_polygons(entry.path())).soup, mesh);
            } catch (const Error& error) {
                ++refused;
                EXPECT_TRUE(has(error.what(), entry.path().filename().string()));
            }
        }
    EXPECT_GT(files, refused);
    for (const char* name :
         {"huge_counts.off", "index_out_of_range.off", "nan_vertex.off", "overflow_vertex.off", "truncated_faces.off"})
        EXPECT_THROW(read_polygons(data / "broken-synthetic" / name), Error) << name;
}
