// `mesh convert` as users run it: valid, invalid and impossible input.
#include "io_examples.h"
#include "ostraka/files/json.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <unistd.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const std::string quads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\nf 1 2\n";

std::string words(const Path& a, const Path& b, const std::string& options = {}) {
    return "mesh convert " + a.string() + " " + b.string() + " " + options;
}

}  // namespace

TEST(ConvertCommand, EveryFormatToEveryOther) {
    const Scratch scratch;
    write_triangles(scratch / "start.ply", octahedron());
    const std::vector<std::string> formats{"ply", "obj", "off", "stl"};
    Path last = scratch / "start.ply";
    for (const auto& from : formats)
        for (const auto& to : formats) {
            const Path file = scratch / (from + "-" + to + "." + to);
            const auto result = run_command(words(last, file, "--quiet"));
            EXPECT_EQ(result.code, 0) << result.err;
            EXPECT_EQ(result.err, "");
            EXPECT_EQ(mesh_checksum(read_mesh(file).mesh), mesh_checksum(build_mesh(octahedron()))) << file;
            last = file;
        }
}

TEST(ConvertCommand, PolygonsAreCutAndMapped) {
    const Scratch scratch;
    const Path input = scratch.file("a.obj", quads);
    const auto result = run_command(words(input, scratch / "a.ply", "--ascii --json --map " + (scratch / "map.json").string()));
    EXPECT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["triangles"].GetInt(), 4);
    EXPECT_EQ(report["result"]["polygons"].GetInt(), 3);
    EXPECT_EQ(report["result"]["notes"].Size(), 1U);
    const Json map = read_json(scratch / "map.json");
    validate(map, "map", "map.json");
    EXPECT_EQ(map["from"].GetInt(), 4);
    EXPECT_EQ(map["to"].GetInt(), 3);
    std::vector<int> polygon_of_triangle;
    for (const auto& entry : map["map"].GetArray()) polygon_of_triangle.push_back(entry.GetInt());
    EXPECT_EQ(polygon_of_triangle, (std::vector<int>{0, 0, 1, 1}));
    EXPECT_NE(read_file(scratch / "a.ply").find("format ascii"), std::string::npos);
    EXPECT_NE(result.err.find("fewer than three distinct corners"), std::string::npos);
}

TEST(ConvertCommand, PolygonsOfAnotherFileAreRestored) {
    const Scratch scratch;
    const Path input = scratch.file("a.obj", quads), bent = scratch / "bent.ply";
    ASSERT_EQ(run_command(words(input, scratch / "a.ply")).code, 0);
    // Another shape of the same triangles.
    MeshFile shape = read_mesh(scratch / "a.ply");
    shape.mesh.point(Vertex(2)) = Point(1, 1, 1);
    shape.extras.face_labels = {4, 4, 9, 9};
    write_mesh(bent, shape.mesh, shape.extras);
    for (const char* name : {"b.obj", "b.off", "b.ply", "b2.ply"}) {
        const Path output = scratch / name;
        const auto result = run_command(
            words(bent, output, "--polygons-of " + input.string() + (std::string(name) == "b2.ply" ? " --ascii" : "")));
        ASSERT_EQ(result.code, 0) << result.err;
        const PolygonSoup back = read_polygons(output);
        EXPECT_EQ(back.polygon_begin, (std::vector<Index>{0, 4, 8})) << name;
        EXPECT_EQ(back.corners, (std::vector<Index>{0, 1, 2, 3, 1, 4, 5, 2})) << name;
        EXPECT_EQ(back.points[2], (std::array<double, 3>{1, 1, 1})) << name;
        EXPECT_EQ(back.extras.face_labels,
                  output.extension() == ".ply" ? (std::vector<std::int32_t>{4, 9}) : std::vector<std::int32_t>());
    }
    // Formats of triangles keep triangles, and a note reports it.
    const auto cut = run_command(words(bent, scratch / "b.stl", "--polygons-of " + input.string()));
    EXPECT_EQ(cut.code, 0);
    EXPECT_NE(cut.err.find("they are triangulated"), std::string::npos) << cut.err;
    // Polygons of another mesh.
    for (const char* obj :
         {"v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\n",
          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 2 5 6 3\nf 1 2 3 4\n"}) {
        const Path other_mesh = scratch.file("wrong.obj", obj);
        const auto result = run_command(words(bent, scratch / "c.obj", "--polygons-of " + other_mesh.string()));
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_NE(result.err.find("originally read from"), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(scratch / "c.obj"));
    }
}

TEST(ConvertCommand, LossesAreReported) {
    const Scratch scratch;
    write_triangles(scratch / "a.ply", octahedron(), full_extras(octahedron()));
    const auto result = run_command(words(scratch / "a.ply", scratch / "a.stl"));
    EXPECT_EQ(result.code, 0);
    for (const char* part : {"colours", "labels", "texture"}) EXPECT_NE(result.err.find(part), std::string::npos) << part;
    EXPECT_NE(result.out.find("triangles"), std::string::npos);
}

TEST(ConvertCommand, NonManifoldFilesAreConverted) {
    const Scratch scratch;
    TriangleSoup soup = octahedron();
    soup.triangles.push_back({0, 3, 2});
    write_triangles(scratch / "a.ply", soup);
    EXPECT_EQ(run_command(words(scratch / "a.ply", scratch / "a.off")).code, 0);
    EXPECT_EQ(read_polygons(scratch / "a.off").polygon_count(), 9U);
}

TEST(ConvertCommand, WrongUsageExitsWithTwo) {
    const Scratch scratch;
    const Path input = scratch.file("a.obj", quads);
    const std::string before = read_file(input);
    for (const auto& arguments :
         {std::string("mesh convert"), words(input, scratch / "a.xyz"), words(input, input),
          words(input, scratch.path() / "." / "a.obj"), words(scratch.file("b.xyz", "1"), scratch / "a.ply"),
          words(input, scratch / "a.ply", "--ascii --binary"),
          words(input, scratch / "a.ply", "--map " + (scratch / "a.ply").string()), words(input, scratch / "a.ply", "--wrong")}) {
        const auto result = run_command(arguments);
        EXPECT_EQ(result.code, 2) << arguments << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err, "");
    }
    EXPECT_EQ(read_file(input), before);
    EXPECT_EQ(count_files(scratch.path()), 2U);
}

TEST(ConvertCommand, FailuresExitWithOneAndLeaveNoFiles) {
    const Scratch scratch;
    const Path input = scratch.file("a.obj", quads);
    const Path earlier = scratch.file("earlier.ply", "what stood here");
    std::filesystem::create_directory(scratch / "folder.ply");
    for (const auto& [arguments, part] : std::vector<std::pair<std::string, std::string>>{
             {words(scratch / "missing.obj", earlier), "missing.obj"},
             {words(scratch / "folder.ply", earlier), "folder.ply"},
             {words(input, scratch / "nowhere" / "a.ply"), "nowhere"},
             {words(input, scratch / "folder.ply"), "folder"},
             {words(scratch.file("bad.obj", quads + "f 1 2 77\n"), earlier), "line 10: a face names vertex 77 of 6"},
             {words(scratch.file("cut.ply",
                                 "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty float x\nproperty "
                                 "float y\nproperty float z\nend_header\n"),
                    earlier),
              "promises"},
             {words(scratch.file("empty.stl", ""), earlier), "is empty"}}) {
        const auto result = run_command(arguments);
        EXPECT_EQ(result.code, 1) << arguments << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }
    EXPECT_EQ(read_file(earlier), "what stood here");
    EXPECT_EQ(count_files(scratch.path()), 6U);
}

TEST(ConvertCommand, AFullDiskLeavesTheEarlierFile) {
    const Scratch scratch;
    write_triangles(scratch / "a.ply", uneven_torus(60, 60));
    const Path earlier = scratch.file("earlier.obj", "what stood here");
    const auto result = run_command(words(scratch / "a.ply", earlier), "ulimit -f 40;");
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("earlier.obj"), std::string::npos);
    EXPECT_NE(result.err.find("cannot be written"), std::string::npos) << result.err;
    EXPECT_EQ(read_file(earlier), "what stood here");
    EXPECT_EQ(count_files(scratch.path()), 2U);
    if (std::filesystem::exists("/dev/full")) {
        std::filesystem::create_symlink("/dev/full", scratch / "full.obj");
        const auto full = run_command(words(scratch / "a.ply", scratch / "full.obj"));
        EXPECT_EQ(full.code, 1);
        EXPECT_NE(full.err.find("No space left"), std::string::npos) << full.err;
        EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
        const std::string line =
            OSTRAKA_COMMAND " " + words(scratch / "a.ply", scratch / "b.obj", "--json > /dev/full 2> /dev/null");
        const int status = std::system(line.c_str());
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << "a report that cannot be printed is a failure";
    }
}

TEST(ConvertCommand, AFolderWithoutRightsIsRefused) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const Scratch scratch;
    const Path input = scratch.file("a.obj", quads);
    std::filesystem::create_directory(scratch / "locked");
    std::filesystem::permissions(scratch / "locked", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    const auto result = run_command(words(input, scratch / "locked" / "a.ply"));
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("cannot be written"), std::string::npos) << result.err;
}
