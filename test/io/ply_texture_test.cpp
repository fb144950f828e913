// PLY files with images, texture coordinates, colours and values in the forms of other programs.
#include "io_examples.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "scratch.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const std::string start = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string corners_property = "property list uchar int vertex_indices\n";

/// A square of two triangles with texture coordinates of the faces, which have images 0 and 1.
std::string two_images(const std::string& comments, const std::string& numbers = "property int texnumber\n") {
    const bool numbered = !numbers.empty();
    return start + comments + "element vertex 4\n" + xyz + "element face 2\n" + corners_property +
           "property list uchar float texcoord\n" + numbers + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1" +
           (numbered ? " 0" : "") + "\n3 0 2 3 6 0 0 .5 1 0 .25" + (numbered ? " 1" : "") + "\n";
}

bool has_note(const std::vector<std::string>& notes, const std::string& part) {
    return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

std::vector<Colour> vertex_colours(const std::string& properties, const std::string& values, const std::string& type = "float") {
    const Scratch scratch;
    std::string text = start + "element vertex 2\n" + xyz;
    for (const std::string_view name : split_words(properties)) text += fmt::format("property {} {}\n", type, name);
    std::size_t position = 0;
    text += "end_header\n";
    for (int v = 0; v < 2; ++v) text += fmt::format("0 0 0 {}\n", line_at(values, position));
    return read_polygons(scratch.file("a.ply", text)).extras.vertex_colours;
}

}  // namespace

TEST(PlyTexture, ImagesOfFaces) {
    const Scratch scratch;
    (void)scratch.file("a_A.png", one_pixel_png(1));
    (void)scratch.file("my skin.png", one_pixel_png(2));
    const std::string comments = "comment TextureFile <this>_A.png\ncomment TextureFile    my skin.png\n";
    const auto soup = read_polygons(scratch.file("a.ply", two_images(comments)));
    ASSERT_EQ(soup.extras.appearance.images.size(), 2U);
    EXPECT_EQ(soup.extras.appearance.images[0]->bytes, one_pixel_png(1));
    EXPECT_EQ(soup.extras.appearance.images[1]->bytes, one_pixel_png(2));
    EXPECT_EQ(soup.extras.face_materials, (std::vector<Index>{0, 1}));
    EXPECT_EQ(soup.extras.corner_texture, (std::vector<TexturePoint>{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {0.5F, 1}, {0, 0.25F}}));
    EXPECT_TRUE(soup.notes.empty());

    const auto unnumbered = read_polygons(scratch.file("a.ply", two_images(comments, "")));
    EXPECT_EQ(unnumbered.extras.face_materials, (std::vector<Index>{0, 0}));
    EXPECT_TRUE(has_note(unnumbered.notes, "which of the images"));
    const auto one_image = read_polygons(scratch.file("a.ply", two_images("comment TextureFile my skin.png\n")));
    EXPECT_EQ(one_image.extras.face_materials, (std::vector<Index>{0, no_index}));
    EXPECT_TRUE(has_note(one_image.notes, "1 faces have an image that is not named"));
    const auto missing = read_polygons(scratch.file("a.ply", two_images("comment TextureFile gone.jpg\n")));
    EXPECT_TRUE(has_note(missing.notes, "the image 'gone.jpg' that a.ply names is not in its folder"));
    EXPECT_TRUE(has_note(read_polygons(scratch.file("a.ply", two_images(""))).notes, "no image is named"));
}

TEST(PlyTexture, CoordinatesOfVerticesBecomeThoseOfCorners) {
    const Scratch scratch;
    for (const char* names : {"s t", "u v", "texture_u texture_v", "texture_s texture_t"}) {
        const auto words = split_words(names);
        const auto soup = read_polygons(scratch.file(
            "a.ply", start + "element vertex 3\n" + xyz +
                         fmt::format("property float {}\nproperty float {}\n", words[0], words[1]) + "element face 1\n" +
                         corners_property + "end_header\n0 0 0 0 .5\n1 0 0 1 0\n0 1 0 .25 nan\n3 2 1 0\n"));
        EXPECT_EQ(soup.extras.corner_texture, (std::vector<TexturePoint>{{0.25F, 0}, {1, 0}, {0, 0.5F}}));
        EXPECT_TRUE(has_note(soup.notes, "1 texture coordinates"));
    }
}

TEST(PlyTexture, PolygonsHaveTwoNumbersPerCorner) {
    const Scratch scratch;
    const auto soup =
        read_polygons(scratch.file("a.ply", start + "element vertex 4\n" + xyz + "element face 1\n" + corners_property +
                                                "property list uchar float texcoord\n" +
                                                "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n"));
    EXPECT_EQ(soup.extras.corner_texture, (std::vector<TexturePoint>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST(PlyColours, NamesAndRangesOfOtherPrograms) {
    const std::vector<Colour> expected{{255, 0, 51, 255}, {0, 255, 102, 255}};
    EXPECT_EQ(vertex_colours("red green blue", "1 0 0.2\n0 1 0.4\n"), expected);
    EXPECT_EQ(vertex_colours("Red Green Blue", "255 0 51\n0 255 102\n"), expected);
    EXPECT_EQ(vertex_colours("r g b", "255 0 51\n0 255 102\n", "uchar"), expected);
    EXPECT_EQ(vertex_colours("r g b a", "255 0 51 1\n0 255 102 1\n"), expected) << "opacity up to 1 beside colours up to 255";
    EXPECT_EQ(vertex_colours("diffuse_red diffuse_green diffuse_blue", "1 0 0.2\n0 1 0.4\n"), expected);
    EXPECT_EQ(vertex_colours("red green blue", "65535 0 13107\n0 65535 26214\n", "ushort"), expected);
    EXPECT_EQ(vertex_colours("red green blue", "255 0 51\n0 255 102\n", "ushort"), expected);
    EXPECT_EQ(vertex_colours("red green blue", "255 0 51\n0 255 102\n", "int"), expected);
    EXPECT_EQ(vertex_colours("r red green b blue", "7 255 0 8 51\n9 0 255 9 102\n"), expected) << "full names come first";
    EXPECT_TRUE(vertex_colours("r g", "1 0\n0 1\n").empty()) << "two channels are no colour";
}

TEST(PlyValues, NumbersOfOtherProgramsAreKept) {
    const Scratch scratch;
    const auto soup = read_polygons(scratch.file(
        "a.ply",
        start +
            "element vertex 3\nproperty float X\nproperty float Y\nproperty float Z\nproperty float nx\nproperty float ny\n"
            "property float nz\nproperty float quality\nproperty int flags\nproperty uchar g\nproperty double s\n"
            "property list uchar float feature_vector\nelement face 1\n" +
            corners_property +
            "property short age\nproperty uchar part_label\nend_header\n"
            "0 0 0 0 0 1 .5 7 1 2 1 9\n1 0 0 0 0 1 nan -7 2 3 0\n0 1 0 0 0 1 .25 0 3 4 0\n3 0 1 2 -3 5\n"));
    expect_same_values(soup.extras.vertex_values,
                       {{"quality", {0.5, std::nan(""), 0.25}}, {"flags", {7, -7, 0}}, {"g", {1, 2, 3}}, {"s", {2, 3, 4}}});
    expect_same_values(soup.extras.face_values, {{"age", {-3}}});
    EXPECT_EQ(soup.extras.face_labels, (std::vector<std::int32_t>{5}));
    EXPECT_TRUE(has_note(soup.notes, "vertex properties not kept: nx, ny, nz, feature_vector"));
    const auto mesh = triangulate(PolygonSoup(soup));
    EXPECT_TRUE(write_triangles(scratch / "b.ply", mesh.soup, mesh.extras).empty());
    expect_same_values(read_polygons(scratch / "b.ply").extras.vertex_values, soup.extras.vertex_values);
}

TEST(PlyTexture, WrittenFilesAreReadTheSame) {
    const Scratch scratch;
    (void)scratch.file("a.png", one_pixel_png(1));
    (void)scratch.file("b.png", one_pixel_png(2));
    std::filesystem::create_directory(scratch / "out");
    for (const char* comments : {"comment TextureFile a.png\ncomment TextureFile b.png\n", "comment TextureFile a.png\n",
                                 "comment TextureFile a.png\ncomment TextureFile gone.png\n", ""}) {
        const auto mesh = triangulate(read_polygons(scratch.file("a.ply", two_images(comments))));
        for (const Encoding encoding : {Encoding::ascii, Encoding::binary}) {
            write_triangles(scratch / "out/c.ply", mesh.soup, mesh.extras, {encoding, {}});
            const auto again = triangulate(read_polygons(scratch / "out/c.ply"));
            EXPECT_EQ(again.soup.triangles, mesh.soup.triangles);
            EXPECT_EQ(again.extras.corner_texture, mesh.extras.corner_texture);
            EXPECT_EQ(again.extras.face_materials, mesh.extras.face_materials) << comments;
            const auto &before = mesh.extras.appearance, &after = again.extras.appearance;
            ASSERT_EQ(after.materials.size(), before.materials.size());
            for (std::size_t m = 0; m < after.materials.size(); ++m) {
                EXPECT_EQ(after.materials[m].name, before.materials[m].name);
                ASSERT_EQ(after.images[m] == nullptr, before.images[m] == nullptr);
                if (after.images[m] != nullptr) {
                    EXPECT_EQ(after.images[m]->bytes, before.images[m]->bytes);
                }
            }
        }
    }
}

TEST(PlyTexture, ColoursOfMaterialsBecomeColoursOfFaces) {
    const Scratch scratch;
    const TriangleSoup soup = octahedron();
    MeshExtras extras;
    extras.face_materials.assign(soup.triangles.size(), 0);
    extras.face_materials[1] = no_index;
    extras.appearance.materials.resize(1);
    extras.appearance.materials[0].base_colour = {1, 0, 0.2158605F, 1};  // sRGB 128
    EXPECT_EQ(write_triangles(scratch / "a.ply", soup, extras).size(), 1U);
    const auto again = read_polygons(scratch / "a.ply");
    EXPECT_EQ(again.extras.face_colours[0], (Colour{255, 0, 128, 255}));
    EXPECT_EQ(again.extras.face_colours[1], (Colour{255, 255, 255, 255}));
}

TEST(PlyTexture, FilesOfOtherPrograms) {
    const Path data = Path(OSTRAKA_SHARED_DATA) / "textured";
    if (!std::filesystem::is_directory(data)) GTEST_SKIP() << "no " << data;
    const auto knot = read_polygons(data / "odd-ply-meshlab-wedge/texturedknot.ply");
    const auto knot_obj = read_polygons(data / "odd-ply-meshlab-wedge/texturedknot.obj");
    EXPECT_EQ(knot.polygon_count(), 2880U);
    EXPECT_EQ(knot.extras.corner_texture.size(), 8640U);
    EXPECT_EQ(knot.extras.appearance.images.at(0)->bytes, knot_obj.extras.appearance.images.at(0)->bytes);
    const auto two = read_polygons(data / "odd-ply-meshlab-wedge/TextureDouble.ply");
    EXPECT_EQ(two.extras.face_materials, (std::vector<Index>{0, 0, 1, 1}));
    EXPECT_EQ(two.extras.appearance.images.at(1)->width, 512);
    const auto fuze = read_polygons(data / "odd-obj-image-with-space/fuze.ply");
    EXPECT_EQ(fuze.extras.vertex_colours.size(), 502U);
    EXPECT_EQ(fuze.extras.face_colours.size(), 1000U);
    EXPECT_EQ(fuze.extras.appearance.images.at(0)->width, 1024);
    for (const char* file : {"BoxTextured.ply", "cube_blender_uv.ply", "cube_blender_uv_meshlab.ply"}) {
        const auto cube = read_polygons(data / "odd-ply-blender-uv" / file);
        EXPECT_EQ(cube.points.size(), 8U) << "joined at the seams";
        EXPECT_EQ(cube.extras.corner_texture.size(), cube.corners.size());
        EXPECT_EQ(cube.vertex_of_file_vertex.size(), 24U);
    }
}
