// The built command as users run it.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

class ResizeCommand : public testing::Test {
protected:
    void SetUp() override {
        mesh = build_mesh(octahedron_sphere(4));
        MeshExtras extras;
        for (const Face f : mesh.faces()) extras.face_labels.push_back(centroid(mesh, f).z() > 0 ? 4 : 9);
        write_mesh(scratch / "ball.ply", mesh, extras);
        AnnotationSet set;
        Annotation cap;
        cap.id = 3, cap.tag = "cap", cap.type = AnnotationType::region;
        for (const Face f : mesh.faces())
            if (centroid(mesh, f).z() > 0.5) cap.faces.push_back(f);
        Annotation line;
        line.id = 4, line.tag = "seam", line.type = AnnotationType::line;
        line.polylines = {{0}};
        for (int i = 0; i < 8; ++i) {
            const Vertex v(line.polylines[0].back());
            Vertex lowest = v;  // towards -z
            for (const Vertex w : CGAL::vertices_around_target(v, mesh))
                if (mesh.point(w).z() < mesh.point(lowest).z()) lowest = w;
            line.polylines[0].push_back(lowest);
        }
        Annotation point;
        point.id = 5, point.tag = "top", point.type = AnnotationType::point, point.points = {4};
        set.annotations = {cap, line, point};
        write_annotations(scratch / "ball.ant.json", {mesh, set}, "ball.ply", {});
    }
    [[nodiscard]] CommandResult run(const std::string& arguments) const { return run_command("mesh " + arguments); }
    [[nodiscard]] std::string path_of(const std::string& name) const { return (scratch / name).string(); }

    Scratch scratch;
    Mesh mesh;
};

double area_of(const Mesh& mesh, const Annotation& annotation) {
    double sum = 0;
    for (const Index f : annotation.faces) sum += face_area(mesh, Face(f));
    return sum;
}

}  // namespace

TEST_F(ResizeCommand, SimplifyCarriesAnnotationsAndLabels) {
    for (const std::string flags : {"", "--protect-outlines", "--outlines ignore", "--method lindstrom-turk"}) {
        SCOPED_TRACE(flags);
        const auto result = run("simplify " + path_of("ball.ply") + " " + path_of("small.ply") +
                                " --vertices 300 --annotations " + path_of("ball.ant.json") + " --annotations-out " +
                                path_of("small.ant.json") + " --labels-out " + path_of("small.txt") + " --vertex-map " +
                                path_of("vertices.json") + " --face-map " + path_of("faces.json") + " " + flags);
        ASSERT_EQ(result.code, 0) << result.err;
        const MeshFile small = read_mesh(path_of("small.ply"));
        EXPECT_EQ(small.mesh.number_of_vertices(), 300u);
        EXPECT_EQ(small.extras.face_labels.size(), small.mesh.number_of_faces());
        const AnnotationSet original = read_annotations(path_of("ball.ant.json"), mesh),
                            simplified = read_annotations(path_of("small.ant.json"), small.mesh);
        ASSERT_EQ(simplified.annotations.size(), 3u);
        EXPECT_NEAR(area_of(small.mesh, *simplified.find(3)) / area_of(mesh, *original.find(3)), 1, 0.1);
        EXPECT_GE(simplified.find(4)->polylines.at(0).size(), 2u);
        EXPECT_EQ(simplified.find(5)->points.size(), 1u);
        EXPECT_NE(result.out.find("cap"), std::string::npos);
        EXPECT_TRUE(std::filesystem::exists(path_of("small.txt")));
        EXPECT_TRUE(std::filesystem::exists(path_of("vertices.json")));
    }
}

TEST_F(ResizeCommand, RefineKeepsAreaAndLengthExactly) {
    for (const std::string flags : {"--vertices 5000", "--levels 1", "--vertices 3000 --scheme longest-edge"}) {
        SCOPED_TRACE(flags);
        const auto result =
            run("refine " + path_of("ball.ply") + " " + path_of("large.obj") + " --annotations " + path_of("ball.ant.json") +
                " --annotations-out " + path_of("large.ant.json") + " --json " + flags);
        ASSERT_EQ(result.code, 0) << result.err;
        const Json report = parse_json(result.out, "report");
        validate(report, "report", "report");
        for (const auto& entry : report["result"]["annotations"].GetArray()) {
            EXPECT_NEAR(entry["after"]["area"].GetDouble(), entry["before"]["area"].GetDouble(), 1e-9);
            EXPECT_NEAR(entry["after"]["length"].GetDouble(), entry["before"]["length"].GetDouble(), 1e-9);
        }
        const MeshFile large = read_mesh(path_of("large.obj"));
        const AnnotationSet refined = read_annotations(path_of("large.ant.json"), large.mesh);
        EXPECT_EQ(refined.annotations.size(), 3u);
    }
}

TEST_F(ResizeCommand, RemeshReachesTheRequestedNumber) {
    const auto result = run("remesh " + path_of("ball.ply") + " " + path_of("new.off") + " --vertices 700");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(read_mesh(path_of("new.off")).mesh.number_of_vertices(), 700u);
    EXPECT_NE(result.err.find("labels"), std::string::npos) << result.err;  // a note reports that they are left out
}

TEST_F(ResizeCommand, TheSameBytesTwiceAndForAnyNumberOfThreads) {
    for (const std::string name : {"a", "b"}) {
        const std::string threads = name == "a" ? " --threads 1" : " --threads 2";
        std::filesystem::create_directory(scratch / name);
        ASSERT_EQ(run("simplify " + path_of("ball.ply") + " " + path_of(name + "/s.ply") + " --vertices 200 --annotations " +
                      path_of("ball.ant.json") + " --annotations-out " + path_of(name + "/s.ant.json") + threads)
                      .code,
                  0);
        ASSERT_EQ(run("remesh " + path_of("ball.ply") + " " + path_of(name + "/r.ply") + " --vertices 900" + threads).code, 0);
        ASSERT_EQ(run("refine " + path_of("ball.ply") + " " + path_of(name + "/f.ply") + " --vertices 4000" + threads).code, 0);
    }
    for (const std::string file : {"s.ply", "s.ant.json", "r.ply", "f.ply"})
        EXPECT_EQ(read_file(path_of("a/" + file)), read_file(path_of("b/" + file))) << file;
}

TEST_F(ResizeCommand, TooFewVerticesGiveTheSmallestMeshAndCodeThree) {
    const auto result = run("simplify " + path_of("ball.ply") + " " + path_of("tiny.ply") + " --vertices 2");
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.err.find("could not be reached"), std::string::npos) << result.err;
    EXPECT_GE(read_mesh(path_of("tiny.ply")).mesh.number_of_vertices(), 4u);
}

TEST_F(ResizeCommand, InvalidUsage) {
    const std::string in = path_of("ball.ply"), out = path_of("out.ply"), annotations = path_of("ball.ant.json");
    write_file(scratch / "bad.ply", "ply\nformat ascii 1.0\nend_header\n");
    write_file(scratch / "out.ply", "earlier");
    struct Case {
        std::string arguments;
        int code;
        std::string message;
    };
    for (const Case& c :
         {Case{"simplify " + in + " " + out, 2, "vertices"},
          {"simplify " + in + " " + out + " --vertices 99999", 2, "fewer"},
          {"simplify " + in + " " + out + " --vertices 0", 2, "vertices"},
          {"simplify " + in + " " + out + " --vertices 100 --method best", 2, "method"},
          {"simplify " + in + " " + in + " --vertices 100", 2, "ball.ply"},
          {"simplify " + in + " " + path_of("out.xyz") + " --vertices 100", 2, "xyz"},
          {"simplify " + in + " " + path_of("nowhere/out.ply") + " --vertices 100", 1, "nowhere"},
          {"simplify " + path_of("none.ply") + " " + out + " --vertices 100", 1, "none.ply"},
          {"simplify " + path_of("bad.ply") + " " + out + " --vertices 100", 1, "bad.ply"},
          {"simplify " + in + " " + out + " --vertices 100 --annotations " + annotations, 2, "--annotations-out"},
          {"simplify " + in + " " + path_of("out.stl") + " --vertices 100 --annotations " + annotations + " --annotations-out " +
               path_of("o.json"),
           2, "stl"},
          {"simplify " + in + " " + out + " --vertices 100 --annotations " + in + " --annotations-out " + path_of("o.json"), 1,
           "ball.ply"},
          {"simplify " + in + " " + out + " --vertices 100 --protect-outlines --outlines follow", 2, "outlines"},
          {"refine " + in + " " + out, 2, "--levels"},
          {"refine " + in + " " + out + " --vertices 3", 2, "simplify"},
          {"refine " + in + " " + out + " --vertices 9999 --levels 1", 2, "one of"},
          {"refine " + in + " " + out + " --levels 1 --scheme sqrt3", 2, "scheme"},
          {"remesh " + in + " " + out, 2, "vertices"},
          {"remesh " + path_of("none.ply") + " " + out + " --vertices 50", 1, "none.ply"}}) {
        SCOPED_TRACE(c.arguments);
        const auto result = run(c.arguments);
        EXPECT_EQ(result.code, c.code) << result.err;
        EXPECT_NE(result.err.find(c.message), std::string::npos) << result.err;
        EXPECT_TRUE(result.out.empty());
        EXPECT_EQ(read_file(scratch / "out.ply"), "earlier");
    }
}

// A region that loses all its faces becomes a line or a point, keeps its tag and has a note.
TEST_F(ResizeCommand, RegionsWithoutFacesAreReported) {
    AnnotationSet set;
    for (int i = 0; i < 60; ++i) {
        Annotation region;
        region.id = i, region.tag = "face " + std::to_string(i), region.type = AnnotationType::region,
        region.faces = {Index(i * 30)};
        set.annotations.push_back(region);
    }
    write_annotations(scratch / "many.ant.json", {mesh, set}, "ball.ply", {});
    const auto result =
        run("simplify " + path_of("ball.ply") + " " + path_of("few.ply") + " --vertices 40 --json --annotations " +
            path_of("many.ant.json") + " --annotations-out " + path_of("few.ant.json"));
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_TRUE(report["result"]["outlines_broken"].GetBool());
    const MeshFile few = read_mesh(path_of("few.ply"));
    const AnnotationSet simplified = read_annotations(path_of("few.ant.json"), few.mesh);
    ASSERT_EQ(simplified.annotations.size(), 60u);
    std::size_t degenerate = 0;
    for (const auto& entry : report["result"]["annotations"].GetArray()) {
        const Annotation* annotation = simplified.find(entry["id"].GetInt());
        ASSERT_NE(annotation, nullptr);
        EXPECT_EQ(annotation->tag, "face " + std::to_string(annotation->id));
        EXPECT_EQ(entry["degenerate"].GetBool(), annotation->type != AnnotationType::region);
        if (!entry["degenerate"].GetBool()) continue;
        ++degenerate;
        EXPECT_FALSE(annotation->note.empty());
    }
    EXPECT_GT(degenerate, 0u);
}

TEST_F(ResizeCommand, ColoursAreCarried) {
    MeshExtras extras;
    for (const Vertex v : mesh.vertices())
        extras.vertex_colours.push_back({std::uint8_t(100 + 50 * mesh.point(v).x()), 7, 8, 255});
    for (const Face f : mesh.faces()) extras.face_colours.push_back({std::uint8_t(100 + 50 * centroid(mesh, f).x()), 1, 2, 255});
    write_mesh(scratch / "coloured.ply", mesh, extras);
    for (const std::string work : {"simplify", "refine"}) {
        SCOPED_TRACE(work);
        const auto result = run(work + " " + path_of("coloured.ply") + " " + path_of("out.ply") + " --vertices " +
                                (work == "refine" ? "6000" : "500"));
        ASSERT_EQ(result.code, 0) << result.err;
        const MeshFile out = read_mesh(path_of("out.ply"));
        ASSERT_EQ(out.extras.vertex_colours.size(), out.mesh.number_of_vertices());
        ASSERT_EQ(out.extras.face_colours.size(), out.mesh.number_of_faces());
        for (const Vertex v : out.mesh.vertices())
            ASSERT_NEAR(out.extras.vertex_colours[v][0], 100 + 50 * out.mesh.point(v).x(), 8);
        for (const Face f : out.mesh.faces())
            ASSERT_NEAR(out.extras.face_colours[f][0], 100 + 50 * centroid(out.mesh, f).x(), 12);
    }
}

/// A curved sheet whose texture coordinates are no linear function of the place, with stripes as its image.
MeshFile striped_sheet() {
    MeshFile file{build_mesh(grid(40, 40, false, false,
                                  [](double u, double v) {
                                      return std::array<double, 3>{u, v, 0.05 * std::sin(3 * u)};
                                  })),
                  {},
                  {},
                  {}};
    Pixels pixels{256, 256, {}};
    for (int i = 0; i < 256 * 256; ++i) {
        const auto value = static_cast<std::uint8_t>(i % 256 / 16 % 2 == 0 ? 255 : 0);
        pixels.rgba.push_back({value, value, value, 255});
    }
    file.extras.appearance.images.push_back(std::make_shared<const Image>(encode(pixels, ImageFormat::png, "stripes.png")));
    file.extras.appearance.materials.resize(1);
    file.extras.appearance.materials[0].image = 0;
    for (const Face face : file.mesh.faces()) {
        file.extras.face_materials.push_back(0);
        for (const Vertex v : corners(file.mesh, face)) {
            const double x = file.mesh.point(v).x(), y = file.mesh.point(v).y();
            file.extras.corner_texture.push_back({static_cast<float>(x * x * x), static_cast<float>(y)});
        }
    }
    return file;
}

TEST(ResizeTexture, SimplifyOffersANewTextureWhereTheOldOneIsSmeared) {
    const Scratch scratch;
    const MeshFile sheet = striped_sheet();
    const std::string in = (scratch / "sheet.glb").string(), out = (scratch / "small.glb").string();
    write_mesh(in, sheet.mesh, sheet.extras);
    const auto fine = run_command("mesh simplify " + in + " " + out + " --vertices 1600");
    ASSERT_EQ(fine.code, 0) << fine.err;
    EXPECT_EQ(fine.err.find("mesh bake"), std::string::npos) << fine.err;
    const auto coarse = run_command("mesh simplify " + in + " " + out + " --vertices 12");
    ASSERT_EQ(coarse.code, 0) << coarse.err;
    const std::string baked = (scratch / "small-baked.glb").string(), offer = "mesh bake " + out + " " + in + " " + baked;
    EXPECT_NE(coarse.err.find("ostraka " + offer), std::string::npos) << coarse.err;
    const auto made = run_command(offer);
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(file_exists(baked));
}

TEST(ResizeRealScan, GargoyleKeepsTopologyAndVolume) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "heritage-scans";
    Path file;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().stem().string().find("gargoyle") != std::string::npos && entry.path().extension() != ".txt")
                file = entry.path();
    if (file.empty()) GTEST_SKIP() << "no gargoyle in " << folder;
    const Scratch scratch;
    const std::string out = (scratch / "small.ply").string();
    const auto result = run_command("mesh simplify " + file.string() + " " + out + " --vertices 4000");
    ASSERT_EQ(result.code, 0) << result.err;
    const Mesh original = read_mesh(file).mesh, simplified = read_mesh(out).mesh;
    EXPECT_EQ(simplified.number_of_vertices(), 4000u);
    EXPECT_EQ(euler_number(simplified), euler_number(original));
    EXPECT_NEAR(volume(simplified) / volume(original), 1, 0.01);
}
