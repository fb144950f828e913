// `ostraka render` as people run it.
#include "ostraka/files/json.h"
#include "ostraka/image/appearance.h"
#include "ostraka/render/colour_scale.h"
#include "read_png.h"
#include "scenes.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace ostraka {
namespace {
using test::run_command;
using test::Scratch;

std::string off_text(const Scene& scene) {
    std::ostringstream text;
    text << "OFF\n" << scene.mesh.points.size() << ' ' << scene.mesh.triangles.size() << " 0\n";
    for (const auto& p : scene.mesh.points) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    for (const auto& t : scene.mesh.triangles) text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    return text.str();
}

std::uint32_t pixel(const Rgb& c) { return 0xFF000000U | std::uint32_t{c.red} << 16 | std::uint32_t{c.green} << 8 | c.blue; }

/// A cube file, the name of a picture, and the command.
class RenderCommand : public ::testing::Test {
protected:
    Scratch scratch;
    Path cube = scratch.file("cube.off", off_text(test::cube()));
    Path png = scratch / "picture.png";

    test::CommandResult run(const std::string& words) {
        return run_command("render " + cube.string() + " " + words + " " + png.string());
    }
    Picture picture() { return test::read_png(png); }
    void refused(const test::CommandResult& result, int code, const std::string& words) {
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_FALSE(std::filesystem::exists(png));
    }
};

TEST_F(RenderCommand, MakesAPictureOfTheRequestedSize) {
    const auto result = run("--size 320x200 --view front --json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(picture().width, 320);
    EXPECT_EQ(picture().height, 200);
    const Json report = parse_json(result.out, "report");
    EXPECT_STREQ(report["command"].GetString(), "render");
    EXPECT_STREQ(report["result"]["picture"].GetString(), "picture.png");
    EXPECT_EQ(report["result"]["panes"][0]["faces"].GetInt(), 12);
    EXPECT_EQ(result.out.find(scratch.path().string()), std::string::npos);
    EXPECT_EQ(picture().at(160, 80), pixel(clay));
}

TEST_F(RenderCommand, QuietWithoutJson) {
    const auto result = run("");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
}

TEST_F(RenderCommand, SameBytesForAnyNumberOfThreads) {
    ASSERT_EQ(run("--threads 1 --edges").code, 0);
    const std::string sequential = read_file(png);
    ASSERT_EQ(run("--threads 3 --edges").code, 0);
    EXPECT_EQ(sequential, read_file(png));
}

TEST_F(RenderCommand, InvalidUsageExitsWithTwo) {
    refused(run("--view behind"), 2, "behind");
    refused(run("--view 0,91"), 2, "0,91");
    refused(run("--up w"), 2, "'w'");
    refused(run("--views seven"), 2, "seven");
    refused(run("--size 0x0"), 2, "0x0");
    refused(run("--zoom 0"), 2, "zoom");
    refused(run("--background mauve"), 2, "mauve");
    refused(run("--annotations a.ant.json --annotations b.ant.json"), 2, "2 times for 1 meshes");
    EXPECT_EQ(run_command("render " + cube.string()).code, 2);
    EXPECT_EQ(run_command("render " + cube.string() + " " + (scratch / "picture.jpg").string()).code, 2);
    EXPECT_EQ(run_command("render").code, 2);
    // The output is an input.
    const Path copy = scratch.file("mesh.png", off_text(test::cube()));
    EXPECT_EQ(run_command("render " + copy.string() + " " + copy.string()).code, 2);
    EXPECT_EQ(read_file(copy), off_text(test::cube()));
}

TEST_F(RenderCommand, InvalidInputExitsWithOne) {
    const Path map = scratch.file("map.txt", "1\n2\n3\n");
    refused(run("--map " + map.string()), 1, "3 values for a mesh of 8 vertices and 12 faces");
    refused(run("--map-on face --map " + map.string()), 1, "12 faces");
    refused(run("--map " + (scratch / "missing.npy").string()), 1, "missing.npy");
    refused(run("--annotations " + (scratch / "missing.ant.json").string()), 1, "missing.ant.json");
    refused(run("--colour labels"), 1, "no labels");
    refused(run_command("render " + (scratch / "missing.off").string() + " " + png.string()), 1, "missing.off");
    refused(run_command("render " + cube.string() + " " + (scratch / "nowhere" / "a.png").string()), 1, "folder");
    const Path words = scratch.file("words.txt", "1\ntwo\n");
    refused(run("--map " + words.string()), 1, "line 2");
    const Path no_values = scratch.file("none.txt", "nan\nnan\nnan\nnan\nnan\nnan\nnan\nnan\n");
    refused(run("--map " + no_values.string()), 1, "no finite value");
    EXPECT_EQ(test::count_files(scratch.path()), 4U);  // the cube and the maps; no temporary file
}

TEST_F(RenderCommand, AnEarlierPictureIsKeptOnFailure) {
    write_file(png, "earlier");
    EXPECT_EQ(run("--view behind").code, 2);
    EXPECT_EQ(run("--map " + (scratch / "missing.txt").string()).code, 1);
    EXPECT_EQ(read_file(png), "earlier");
}

TEST_F(RenderCommand, MapsColourFacesAndVertices) {
    std::string faces;
    for (int i = 0; i < 12; ++i) faces += i < 2 ? "1\n" : "0\n";
    const Path map = scratch.file("faces.txt", faces);
    ASSERT_EQ(run("--no-legend --size 300x300 --view front --map " + map.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel(colour_of({0, 1, false, ""}, 1)));
    ASSERT_EQ(run("--no-legend --size 300x300 --view front --map-range 0,2 --map " + map.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel(colour_of({0, 2, false, ""}, 1)));
    const auto unlabelled = picture();
    ASSERT_EQ(run("--size 300x300 --view front --map-label 'thickness (mm)' --map " + map.string()).code, 0);
    EXPECT_NE(picture().argb, unlabelled.argb);
    EXPECT_EQ(run("--map-range 2,1 --map " + map.string()).code, 2);
    // Every option and file is in the report.
    const auto result = run("--json --map-range 0,2 --unit mm --map " + map.string());
    const Json report = parse_json(result.out, "report");
    EXPECT_STREQ(report["provenance"]["options"]["map-range"].GetString(), "0,2");
    EXPECT_STREQ(report["provenance"]["options"]["unit"].GetString(), "mm");
    EXPECT_EQ(report["provenance"]["inputs"].Size(), 2U);
}

TEST_F(RenderCommand, DrawsNonManifoldMeshes) {
    const Path non_manifold =
        scratch.file("bad.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 0 1\n0 1 0\n0 -1 0\n3 0 1 2\n3 0 1 3\n3 0 1 4\n");
    const auto result = run_command("render " + non_manifold.string() + " " + png.string());
    EXPECT_EQ(result.code, 0) << result.err;
}

TEST_F(RenderCommand, AnnotationsTakeTheirColours) {
    const Path annotations =
        scratch.file("cube.ant.json", R"({"format": "ostraka-annotations", "version": 1, "unit": "mm", "up": [0, 0, 1],
        "annotations": [
          {"id": 1, "tag": "whole", "colour": [10, 200, 30], "type": "region", "all": true},
          {"id": 2, "tag": "face", "colour": [200, 30, 10], "type": "region", "faces": [0, 1]},
          {"id": 3, "tag": "seam", "colour": [0, 0, 255], "type": "line", "polylines": [[0, 1]]},
          {"id": 4, "tag": "tip", "colour": [255, 255, 0], "type": "point", "points": [4, 7]}]})");
    ASSERT_EQ(run("--no-legend --size 300x300 --view front --annotations " + annotations.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel({200, 30, 10}));
    const auto result = run("--json --view=-20,-20 --annotations " + annotations.string());
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(report["result"]["panes"][0]["markers"].GetInt(), 2);
    EXPECT_EQ(report["result"]["panes"][0]["markersShown"].GetInt(), 1);  // vertex 7 is at the back
    ASSERT_EQ(run("--no-legend --size 300x300 --view back --annotations " + annotations.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel({10, 200, 30}));
    ASSERT_EQ(run_command("render " + cube.string() + " " + cube.string() + " --annotations none --annotations " +
                          annotations.string() + " " + png.string())
                  .code,
              0);
}

TEST_F(RenderCommand, OutlinesOfLargerRegionsDoNotRunOverSmallerOnes) {
    // The larger region ends at the diagonal of the front, both triangles of which the smaller one covers.
    const Path annotations = scratch.file("cube.ant.json", R"({"format": "ostraka-annotations", "version": 1, "annotations": [
          {"id": 1, "tag": "small", "colour": [200, 30, 10], "type": "region", "faces": [0, 1]},
          {"id": 2, "tag": "large", "colour": [10, 200, 30], "type": "region", "faces": [1, 2, 3, 4]}]})");
    ASSERT_EQ(run("--no-legend --size 300x300 --view front --annotations " + annotations.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel({200, 30, 10}));
    std::size_t dark = 0;
    for (int x = 120; x < 180; ++x)
        for (int y = 120; y < 180; ++y) dark += picture().at(x, y) != pixel({200, 30, 10}) ? 1 : 0;
    EXPECT_EQ(dark, 0U);
}

TEST_F(RenderCommand, LabelsOfTheFileAreShown) {
    std::ostringstream ply;
    const Scene scene = test::cube();
    ply << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 12\n"
        << "property list uchar int vertex_indices\nproperty int label\nend_header\n";
    for (const auto& p : scene.mesh.points) ply << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    for (std::size_t i = 0; i < 12; ++i) {
        const auto& t = scene.mesh.triangles[i];
        ply << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << (i < 2 ? 4 : 9) << '\n';
    }
    const Path file = scratch.file("labels.ply", ply.str());
    ASSERT_EQ(run_command("render --no-legend --size 300x300 --view front " + file.string() + " " + png.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel(category_colour(0)));
    ASSERT_EQ(run_command("render --no-legend --size 300x300 --view back " + file.string() + " " + png.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel(category_colour(1)));
    ASSERT_EQ(
        run_command("render --no-legend --colour clay --size 300x300 --view back " + file.string() + " " + png.string()).code, 0);
    EXPECT_EQ(picture().at(150, 130), pixel(clay));
}

/// A cube with one colour for all vertices, as PLY.
std::string coloured_ply() {
    std::ostringstream ply;
    const Scene scene = test::cube();
    ply << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
        << "property uchar green\nproperty uchar blue\nproperty float quality\nelement face 12\n"
        << "property list uchar int vertex_indices\nend_header\n";
    for (const auto& p : scene.mesh.points) ply << p[0] << ' ' << p[1] << ' ' << p[2] << " 10 200 30 " << p[2] << '\n';
    for (const auto& t : scene.mesh.triangles) ply << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    return ply.str();
}

TEST_F(RenderCommand, ColoursOfTheFileAreShownOrANoteSaysThatTheyAreNot) {
    const Path file = scratch.file("coloured.ply", coloured_ply());
    const auto draw = [&](const std::string& words) {
        return run_command("render --no-legend --size 300x300 --view front " + file.string() + " " + words + " " + png.string());
    };
    auto result = draw("");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(picture().at(150, 130), pixel({10, 200, 30}));
    result = draw("--colour clay");
    EXPECT_NE(result.err.find("colours in the file are not shown"), std::string::npos) << result.err;
    EXPECT_EQ(picture().at(150, 130), pixel(clay));
    const Path annotations = scratch.file("coloured.ant.json", R"({"format": "ostraka-annotations", "version": 1, "annotations": [
          {"id": 1, "tag": "face", "colour": [200, 30, 10], "type": "region", "faces": [0, 1]}]})");
    result = draw("--annotations " + annotations.string());
    EXPECT_NE(result.err.find("colours in the file are not shown"), std::string::npos) << result.err;
    EXPECT_EQ(picture().at(150, 130), pixel({200, 30, 10}));
    result = draw("--colour own --annotations " + annotations.string());
    EXPECT_EQ(result.err.find("not shown"), std::string::npos) << result.err;
    EXPECT_EQ(picture().at(150, 130), pixel({10, 200, 30}));  // the annotation is an outline
    ASSERT_EQ(draw("--property quality").code, 0);
    EXPECT_NE(picture().at(150, 60), picture().at(150, 200));  // values from -1 to 1 along z
    EXPECT_EQ(draw("--property height").code, 1);
    EXPECT_EQ(draw("--colour texture").code, 1);
    EXPECT_EQ(draw("--colour values").code, 2);
    EXPECT_EQ(draw("--colour annotations").code, 2);
}

TEST_F(RenderCommand, TexturesAreShownExactlyInFlatLight) {
    Pixels pixels{2, 2, {{250, 10, 20, 255}, {30, 240, 50, 255}, {60, 70, 230, 255}, {80, 90, 100, 255}}};
    write_file(scratch / "pot.png", encode(pixels, ImageFormat::png, "pot.png").bytes);
    const Path material = scratch.file("pot.mtl", "newmtl body\nKd 1 1 1\nmap_Kd pot.png\n");
    ASSERT_TRUE(file_exists(material));
    const Path file = scratch.file("pot.obj",
                                   "mtllib pot.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                   "usemtl body\nf 1/1 2/2 3/3 4/4\n");
    const auto result = run_command("render --no-scale-bar --light flat --size 400x400 --view front --dpi 254 --json " +
                                    file.string() + " " + png.string());
    ASSERT_EQ(result.code, 0) << result.err;
    // The square is 368 pixels wide; half a pixel from a quarter and three quarters of it are the centres of the image's pixels.
    const auto expect_near = [&](int column, int row, const Rgb& expected) {
        const std::uint32_t seen = picture().at(column, row);
        const auto light = [](std::uint32_t channel) { return linear_from_srgb(static_cast<std::uint8_t>(channel & 255U)); };
        const float half_pixel = 0.5F / 184;
        EXPECT_NEAR(light(seen >> 16U), light(expected.red), 2 * half_pixel + 0.0065F);
        EXPECT_NEAR(light(seen >> 8U), light(expected.green), 2 * half_pixel + 0.0065F);
        EXPECT_NEAR(light(seen), light(expected.blue), 2 * half_pixel + 0.0065F);
    };
    expect_near(108, 108, {250, 10, 20});
    expect_near(292, 108, {30, 240, 50});
    expect_near(292, 292, {80, 90, 100});
    const Json report = parse_json(result.out, "report");
    EXPECT_NEAR(report["result"]["dpi"].GetDouble(), 254, 1e-9);
    EXPECT_NE(read_file(png).find("pHYs"), std::string::npos);
    const auto clay_coloured = run_command("render --colour clay " + file.string() + " " + png.string());
    EXPECT_NE(clay_coloured.err.find("texture in the file is not shown"), std::string::npos) << clay_coloured.err;
    const auto scaled = run_command("render --scale 1:2 --unit m " + file.string() + " " + png.string());
    EXPECT_EQ(scaled.code, 2);  // half a metre of paper at 300 dpi
    EXPECT_NE(scaled.err.find("--size"), std::string::npos) << scaled.err;
    EXPECT_EQ(run_command("render --scale 1:20 --unit m " + file.string() + " " + png.string()).code, 0);
    EXPECT_EQ(run_command("render --scale 1:20 " + file.string() + " " + png.string()).code, 2);
}

}  // namespace
}  // namespace ostraka
