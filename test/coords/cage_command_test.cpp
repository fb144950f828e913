// `ostraka cage weights` and `ostraka cage influence` as people run them.
#include "cages.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinate_file.h"
#include "scratch.h"

namespace ostraka {
namespace {

using test::run_command;

class CageCommand : public ::testing::Test {
protected:
    test::Scratch scratch;
    Mesh mesh = build_mesh(test::moved(test::octahedron_sphere(2), 0.45, {0.5, 0.5, 0.5})), cage = build_mesh(test::box(1));
    std::string ball = (scratch / "ball.ply").string(), box = (scratch / "box.obj").string(),
                weights = (scratch / "w.npy").string(), map = (scratch / "map.ply").string();

    void SetUp() override {
        write_mesh(ball, mesh);
        // Six quads.
        write_file(box,
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                   "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
        cage = read_mesh(box).mesh;
    }
    static void refused(const std::string& words, int code, const std::string& text) {
        const auto result = run_command("cage " + words);
        EXPECT_EQ(result.code, code) << words << '\n' << result.err;
        EXPECT_NE(result.err.find(text), std::string::npos) << words << '\n' << result.err;
        EXPECT_EQ(result.out, "") << words;
    }
};

TEST_F(CageCommand, WeightsWithTheirCertificate) {
    auto result = run_command("cage weights " + ball + " " + box + " " + weights);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("fit for deformation"), std::string::npos) << result.out;
    EXPECT_NE(result.err.find("cut into 12 triangles"), std::string::npos) << result.err;
    const Coordinates c = read_coordinates(weights, mesh, cage);
    EXPECT_EQ(c.vertex, compute_coordinates("mean-value", cage, mesh).vertex);
    const std::string bytes = read_file(weights), header = read_file(coordinate_header_file(weights));
    result = run_command("cage weights " + ball + " " + box + " " + weights + " --threads 1 --json --quiet");
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(read_file(weights), bytes);
    EXPECT_EQ(read_file(coordinate_header_file(weights)), header);
    const Json report = parse_json(result.out, "report");
    EXPECT_TRUE(report["result"]["holds"].GetBool());
    EXPECT_LT(report["result"]["certificate"]["linearPrecision"].GetDouble(), 1e-13);
    EXPECT_LT(report["result"]["certificate"]["lagrange"].GetDouble(), 1e-15);

    result = run_command("cage weights " + ball + " " + box + " " + weights + " --kind green");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("only be used for deformation without constraints"), std::string::npos) << result.err;
    EXPECT_TRUE(read_coordinates(weights, mesh, cage).has_normals());
}

TEST_F(CageCommand, InfluenceMaps) {
    ASSERT_EQ(run_command("cage weights " + ball + " " + box + " " + weights).code, 0);
    const std::string start = "cage influence " + ball + " " + box + " " + weights + " " + map;
    auto result = run_command(start + " --cage-vertex 6 --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Coordinates c = read_coordinates(weights, mesh, cage);
    EXPECT_EQ(parse_json(result.out, "report")["result"]["max"].GetDouble(), c.vertex.col(6).maxCoeff());
    MeshFile coloured = read_mesh(map);
    EXPECT_EQ(coloured.mesh.number_of_vertices(), mesh.number_of_vertices());
    EXPECT_EQ(coloured.extras.vertex_colours.size(), mesh.number_of_vertices());
    EXPECT_NE(read_file(map).find("property double quality"), std::string::npos);

    AnnotationSet set;
    Annotation& top = set.annotations.emplace_back();
    top.id = 4;
    top.tag = "top";
    for (const Face f : mesh.faces())
        if (centroid(mesh, f).z() > 0.8) top.faces.push_back(f);
    ensure_root(set, mesh);
    const std::string ant = (scratch / "ball.ant.json").string();
    write_annotations(ant, {mesh, set}, ball, {});
    result = run_command(start + " --annotations " + ant + " --annotation top --threshold 0.15 --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(std::string(report["result"]["on"].GetString()), "cage");
    // The upper four corners of the box, and none of the lower.
    std::vector<Index> above;
    for (const auto& v : report["result"]["above"].GetArray()) above.push_back(v.GetUint());
    std::sort(above.begin(), above.end());
    EXPECT_EQ(above, (std::vector<Index>{4, 5, 6, 7}));
    EXPECT_EQ(read_mesh(map).mesh.number_of_vertices(), 8U);
    EXPECT_EQ(run_command(start + " --annotations " + ant + " --annotation 4 --by sum").code, 0);
    result = run_command(start);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("carry 95 %"), std::string::npos);
    refused("influence " + ball + " " + box + " " + weights + " " + map + " --annotations " + ant + " --annotation foot", 1,
            "'foot'");
    refused("influence " + ball + " " + box + " " + weights + " " + map + " --annotation foot", 2, "without a file");
    refused("influence " + ball + " " + box + " " + weights + " " + map + " --cage-vertex 8", 2, "no cage vertex 8");
}

TEST_F(CageCommand, MakeReportsDeviationsFromTheRequest) {
    const std::string generated_cage = (scratch / "made.ply").string(), loose = (scratch / "loose.off").string();
    auto result = run_command("cage make " + ball + " " + generated_cage + " --vertices 41 --mirror 0.5,0.5,0.5,1,0,0");
    ASSERT_EQ(result.code, 0) << result.err;
    const std::size_t count = read_mesh(generated_cage).mesh.number_of_vertices();
    EXPECT_EQ(result.err.find("the same number of vertices on both sides") != std::string::npos, count != 41)
        << count << result.err;
    result = run_command("cage make " + ball + " " + generated_cage + " --vertices 5000 --alpha 0.2 --quiet");
    ASSERT_EQ(result.code, 0) << result.err;
    result = run_command("cage make " + ball + " " + generated_cage + " --vertices 5000 --alpha 0.2");
    EXPECT_NE(result.err.find("its wrap has no more"), std::string::npos) << result.err;
    // A ball with a vertex that no face has, outside.
    TriangleSoup soup = to_soup(mesh);
    soup.points.push_back({0.5, 0.5, 9});
    write_mesh(loose, build_mesh(soup));
    result = run_command("cage make " + loose + " " + generated_cage + " --vertices 40");
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.err.find("1 vertex without faces"), std::string::npos) << result.err;
    result = run_command("cage check " + loose + " " + generated_cage);
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.out.find("vertex " + std::to_string(soup.points.size() - 1)), std::string::npos) << result.out;
    refused("weights " + loose + " " + generated_cage + " " + weights + " --kind green", 1,
            std::to_string(soup.points.size() - 1));
}

TEST_F(CageCommand, ReportsImpossibleRequests) {
    const std::string generated_cage = (scratch / "made.ply").string(), line = (scratch / "line.off").string(),
                      edit = (scratch / "a.edit.json").string();
    refused("make " + ball + " " + generated_cage + " --mirror nan,0,0,1,0,0", 2, "not finite");
    refused("make " + ball + " " + generated_cage + " --mirror 0,0,0,0,nan,0", 2, "not finite");
    write_file(line, "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
    refused("make " + line + " " + generated_cage, 1, "has no face with an area");
    write_file(edit, R"({"format": "ostraka-edit", "version": 1, "steps": [
        {"select": {"all": true}, "translate": [1, 0, 0]}, {"select": {"annotation": "top"}, "translate": [1, 0, 0]}]})");
    refused("edit " + box + " " + edit + " " + generated_cage, 1, "/steps/1: selects by annotation");
    EXPECT_FALSE(std::filesystem::exists(generated_cage));
    // A closed but flat cage gives a report, not a failure.
    const std::string flat = (scratch / "flat.off").string();
    write_file(flat, "OFF\n4 4 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n3 0 1 2\n3 0 3 1\n3 1 3 2\n3 2 3 0\n");
    const auto result = run_command("cage check " + ball + " " + flat);
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.out.find("has no face with an area"), std::string::npos) << result.out;
    ASSERT_EQ(run_command("cage weights " + ball + " " + box + " " + weights).code, 0);
    refused("influence " + ball + " " + box + " " + weights + " " + map + " --annotations a --annotation 1 --threshold nan", 2,
            "--threshold is not finite");
}

TEST_F(CageCommand, BadInput) {
    const std::string open = (scratch / "open.ply").string(), far = (scratch / "far.ply").string();
    write_mesh(open, build_mesh(test::patch(3, 3)));
    write_mesh(far, build_mesh(test::moved(test::octahedron_sphere(1), 1, {3, 0, 0})));
    refused("weights " + ball + " " + open + " " + weights, 1, "is open");
    refused("weights " + ball + " " + far + " " + weights + " --kind green", 1, "strictly inside");
    refused("weights " + ball + " " + box + " " + weights + " --kind no-such-kind", 2, "no-such-kind");
    refused("weights " + ball + " " + box + " " + (scratch / "w.txt").string(), 2, ".npy");
    refused("weights " + ball + " " + (scratch / "none.ply").string() + " " + weights, 1, "none.ply");
    refused("weights " + ball + " " + box + " " + (scratch / "no" / "w.npy").string(), 1, "folder");
    EXPECT_EQ(test::count_files(scratch.path()), 4U) << "nothing was written";
    ASSERT_EQ(run_command("cage weights " + ball + " " + box + " " + weights).code, 0);
    refused("influence " + far + " " + box + " " + weights + " " + map, 1, "another mesh");
    refused("influence " + ball + " " + far + " " + weights + " " + map, 1, "another cage");
    refused("influence " + ball + " " + box + " " + (scratch / "x.npy").string() + " " + map, 1, "x.npy");
    refused("influence " + ball + " " + box + " " + weights + " " + ball, 2, "also an input");
}

}  // namespace
}  // namespace ostraka
