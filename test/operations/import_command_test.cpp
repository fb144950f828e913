// `ostraka import` as users run it: several scans at once, point clouds, scans that cannot be read.
#include "meshes.h"
#include "ostraka/files/json.h"
#include "ostraka/image/image.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

using namespace ostraka;
using namespace ostraka::test;

namespace {

class ImportCommand : public ::testing::Test {
protected:
    [[nodiscard]] std::string at(const std::string& name) const { return "'" + (scratch / name).string() + "'"; }
    /// The result of an import as JSON, with its exit code.
    Json import(const std::string& arguments, int code) const {
        const CommandResult result = run_command("import " + arguments + " --json");
        EXPECT_EQ(result.code, code) << arguments << result.err;
        Json report = parse_json(result.out.empty() ? "{}" : result.out, "the report");
        Json copy;
        if (const JsonValue* member = find_member(report, "result")) copy.CopyFrom(*member, copy.GetAllocator());
        return copy;
    }
    [[nodiscard]] MeshFile object(const std::string& name) const { return read_mesh(scratch / ("out/" + name)); }
    [[nodiscard]] Json map(const std::string& name) const { return read_json(scratch / ("out/" + name)); }

    /// A closed box of quadrilaterals with an image on each side, in a folder of its own.
    void write_textured_box(const std::string& folder, std::array<std::uint8_t, 4> colour, double size) const {
        make_folder(scratch / folder);
        Pixels pixels{4, 4, {}};
        pixels.rgba.assign(16, colour);
        write_file(scratch / (folder + "/skin.png"), encode(pixels, ImageFormat::png, {}).bytes);
        std::string text = "mtllib box.mtl\n";
        for (int v = 0; v < 8; ++v) text += fmt::format("v {} {} {}\n", size * (v & 1), size * (v >> 1 & 1), size * (v >> 2 & 1));
        text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\n";
        for (const char* side :
             {"1/1 3/2 4/3 2/4", "5/1 6/2 8/3 7/4", "1/1 2/2 6/3 5/4", "3/1 7/2 8/3 4/4", "1/1 5/2 7/3 3/4", "2/1 4/2 8/3 6/4"})
            text += fmt::format("f {}\n", side);
        write_file(scratch / (folder + "/box.obj"), text);
        write_file(scratch / (folder + "/box.mtl"), "newmtl m\nmap_Kd skin.png\n");
    }
    /// Points of a sphere about a place, evenly distributed.
    static std::string sphere_points(std::size_t count, double x0, const char* more = "") {
        std::string text;
        for (std::size_t i = 0; i < count; ++i) {
            const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count), r = std::sqrt(1 - z * z);
            const double turn = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
            text += fmt::format("{} {} {}{}\n", x0 + r * std::cos(turn), r * std::sin(turn), z, more);
        }
        return text;
    }
    Scratch scratch;
};

double volume_of(const Mesh& mesh) {
    double sum = 0;
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        const Point o(0, 0, 0);
        sum += (mesh.point(a) - o) * CGAL::cross_product(mesh.point(b) - o, mesh.point(c) - o) / 6;
    }
    return sum;
}

}  // namespace

TEST_F(ImportCommand, SeveralScansBecomeObjectsAndABadOneStopsNoOther) {
    write_textured_box("red", {255, 0, 0, 255}, 1);
    write_textured_box("blue", {0, 0, 255, 255}, 2);
    write_file(scratch / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    write_file(scratch / "model.dae", "<COLLADA/>");
    const Json result = import(at("red/box.obj") + " " + at("broken.ply") + " " + at("blue/box.obj") + " " + at("model.dae") +
                                   " " + at("out") + " --unit mm",
                               3);
    ASSERT_EQ(result["objects"].Size(), 4U);
    EXPECT_EQ(result["refused"].GetInt(), 2);
    EXPECT_FALSE(result["sound"].GetBool());
    EXPECT_EQ(text_in(result["objects"][1], "state"), "refused");
    EXPECT_NE(text_in(result["objects"][1], "remarks").find("broken.ply"), std::string::npos);
    EXPECT_NE(text_in(result["objects"][3], "remarks").find("assimp"), std::string::npos);
    EXPECT_EQ(text_in(result["objects"][0], "mesh"), "box.ply");
    EXPECT_EQ(text_in(result["objects"][2], "mesh"), "box-2.ply");
    // Each has its own image, although both files call it skin.png.
    const std::pair<const char*, std::array<std::uint8_t, 4>> expected[]{{"box.ply", {255, 0, 0, 255}},
                                                                         {"box-2.ply", {0, 0, 255, 255}}};
    double size = 1;
    for (const auto& [name, colour] : expected) {
        const MeshFile mesh = object(name);
        ASSERT_EQ(mesh.extras.appearance.images.size(), 1U);
        ASSERT_NE(mesh.extras.appearance.images[0], nullptr);
        EXPECT_EQ(decode(*mesh.extras.appearance.images[0], name).rgba[0], colour) << name;
        EXPECT_NEAR(volume_of(mesh.mesh), size * size * size, 1e-12);
        size += 1;
    }
    // The raw files keep their places below the folder of the scans.
    for (const char* raw : {"red/box.obj", "red/box.mtl", "red/skin.png", "blue/box.obj", "blue/box.mtl", "blue/skin.png"})
        EXPECT_EQ(read_file(scratch / (std::string("out/raw/") + raw)), read_file(scratch / raw)) << raw;
    EXPECT_FALSE(file_exists(scratch / "out/raw/broken.ply"));
    EXPECT_EQ(text_in(read_json(scratch / "out/box-2.ant.json"), "unit"), "mm");
}

TEST_F(ImportCommand, ASurfaceIsMadeOfPoints) {
    write_file(scratch / "cloud.xyz", sphere_points(3000, 0, " 200 100 50"));
    const Json result = import(at("cloud.xyz") + " " + at("out"), 0);
    const MeshFile mesh = object("cloud.ply");
    EXPECT_NEAR(volume_of(mesh.mesh), 4 * std::numbers::pi / 3, 0.02);
    ASSERT_EQ(mesh.extras.vertex_colours.size(), mesh.mesh.number_of_vertices());
    EXPECT_EQ(mesh.extras.vertex_colours[0], (Colour{200, 100, 50, 255}));
    // The map leads from each point to the vertex at its place.
    const Json points = map("cloud.vertices.map.json");
    ASSERT_EQ(points["map"].Size(), 3000U);
    std::size_t placed = 0;
    for (rapidjson::SizeType i = 0; i < 3000; ++i) {
        if (points["map"][i].GetInt() < 0) continue;
        ++placed;
        const double z = 1 - (2.0 * i + 1) / 3000;
        EXPECT_NEAR(mesh.mesh.point(Vertex(points["map"][i].GetUint())).z(), z, 1e-12);
    }
    EXPECT_GT(placed, 2900U);
    EXPECT_TRUE(file_exists(scratch / "out/raw/cloud.xyz"));
}

TEST_F(ImportCommand, PointsWithoutASurfaceAndEmptyFilesAreRefused) {
    write_file(scratch / "few.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    write_file(scratch / "line.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
               "end_header\n1 2 3\n");
    write_file(scratch / "empty.obj", "");
    write_file(scratch / "flat.obj", "v 0 0 0\nf 1 1 1\n");
    for (const char* name : {"few.xyz", "line.ply", "empty.obj", "flat.obj"}) {
        const CommandResult result = run_command("import " + at(name) + " " + at("out"));
        EXPECT_EQ(result.code, 1) << name << result.err;
        EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
    }
    EXPECT_FALSE(is_folder(scratch / "out") && count_files(scratch / "out") > 0);
    // All of several: an error that lists them.
    const CommandResult all = run_command("import " + at("few.xyz") + " " + at("empty.obj") + " " + at("out"));
    EXPECT_EQ(all.code, 1);
    EXPECT_NE(all.err.find("few.xyz"), std::string::npos) << all.err;
    EXPECT_NE(all.err.find("empty.obj"), std::string::npos) << all.err;
}

TEST_F(ImportCommand, AnImageBelongsToOneScan) {
    write_textured_box("red", {255, 0, 0, 255}, 1);
    EXPECT_EQ(
        run_command("import " + at("red/box.obj") + " " + at("red/box.obj") + " " + at("out") + " --image " + at("red/skin.png"))
            .code,
        2);
}

TEST_F(ImportCommand, OperationsWorkOnUnrepairedScans) {
    // A sphere with three sheets at an edge, a triangle turned over and a loose pair that touches it in a vertex.
    TriangleSoup soup = octahedron_sphere(3);
    soup.points.push_back({2, 0, 0});
    const auto [a, b, c] = soup.triangles[0];
    soup.triangles.push_back({a, b, static_cast<Index>(soup.points.size() - 1)});
    std::swap(soup.triangles[9][0], soup.triangles[9][1]);
    static_cast<void>(c);
    write_triangles(scratch / "scan.ply", soup);
    write_file(scratch / "cap.recipe.json",
               R"({"format":"ostraka-recipe","version":1,"annotations":[{"id":0,"tag":"cap","type":"region","select":)"
               R"({"halfspace":{"point":[0,0,0.5],"normal":[0,0,1]}}}]})");
    const auto succeeds = [&](const std::string& words, bool with_note = true) {
        const CommandResult result = run_command(words);
        EXPECT_EQ(result.code, 0) << words << "\n" << result.err;
        if (with_note) {
            EXPECT_NE(result.err.find("is not an oriented manifold"), std::string::npos) << words << "\n" << result.err;
        }
    };
    const std::string scan = at("scan.ply");
    succeeds("annotation apply " + scan + " " + at("cap.recipe.json") + " " + at("scan.ant.json"));
    succeeds("measure take " + scan + " --annotations " + at("scan.ant.json") +
             " --annotation cap --tool bounding --direction z");
    succeeds("render " + scan + " " + at("scan.png") + " --annotations " + at("scan.ant.json") + " --size 64x64", false);
    succeeds("slice " + scan + " --count 3");
    succeeds("mesh simplify " + scan + " " + at("small.ply") + " --vertices 100");
    succeeds("annotation transfer " + scan + " " + at("scan.ant.json") + " " + at("small.ply") + " " + at("small.ant.json"));
    EXPECT_TRUE(file_exists(scratch / "scan.png"));
}
