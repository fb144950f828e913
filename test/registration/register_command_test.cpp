// mesh register, as people run it.
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/json.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/synthetic/make_mesh.h"
#include "scratch.h"

#include <Eigen/Geometry>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Mesh synthetic_mesh(const std::string& name, std::uint64_t vertices) {
    MakeOptions options;
    options.vertices = vertices;
    return make_mesh(synthetic_object(name), options).mesh;
}

class RegisterCommand : public ::testing::Test {
protected:
    void SetUp() override {
        const Mesh hand = synthetic_mesh("hand", 3000);
        Mesh moved = hand, mirror = hand;
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
        for (const Vertex v : hand.vertices()) {
            moved.point(v) = point_of(Eigen::Vector3d(0.001 * (turn * eigen(hand.point(v))) + Eigen::Vector3d(5, -7, 1)));
            mirror.point(v) = Point(-hand.point(v).x(), hand.point(v).y(), hand.point(v).z());
        }
        write_mesh(scratch / "moved.ply", moved);
        write_mesh(scratch / "mirror.ply", mirror);
        write_mesh(scratch / "hand.ply", synthetic_mesh("hand", 6000));
        write_mesh(scratch / "chair.ply", synthetic_mesh("chair", 3000));
    }
    [[nodiscard]] std::string file_path(const std::string& name) const { return (scratch / name).string(); }
    Scratch scratch;
};

}  // namespace

TEST_F(RegisterCommand, WritesTheMovedMeshAndTheMatrix) {
    const CommandResult result = run_command("mesh register " + file_path("moved.ply") + " " + file_path("hand.ply") + " " +
                                             file_path("out.ply") + " --matrix " + file_path("m.json") + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_STREQ(report["result"]["verdict"].GetString(), "aligned");
    EXPECT_NEAR(report["result"]["scale"].GetDouble(), 1000, 1);
    const Json matrix = read_json(file_path("m.json"));
    Eigen::Matrix4d m;
    for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = 0; j < 4; ++j) m(i, j) = matrix[i][j].GetDouble();
    const Mesh from = read_mesh(file_path("moved.ply")).mesh, out = read_mesh(file_path("out.ply")).mesh,
               hand = synthetic_mesh("hand", 3000);
    for (const Vertex v : from.vertices()) {
        const Eigen::Vector3d expected = (m * eigen(from.point(v)).homogeneous()).head<3>();
        EXPECT_LT((eigen(out.point(v)) - expected).norm(), 1e-9 * box_diagonal(hand));
        EXPECT_LT((eigen(out.point(v)) - eigen(hand.point(v))).norm(), 2e-3 * box_diagonal(hand));
    }
}

TEST_F(RegisterCommand, MovesAnnotationsAndReportsTheUncertainty) {
    const Mesh from = read_mesh(file_path("moved.ply")).mesh;
    AnnotationSet set;
    set.unit = "m";
    set.up = std::array<double, 3>{0, 0, 1};
    ensure_root(set, from);
    Annotation& part = set.annotations.emplace_back();
    part.id = 4;
    part.tag = "part";
    part.faces = {0, 1, 2};
    write_annotations(file_path("moved.ant.json"), {from, set}, file_path("moved.ply"), {});
    const CommandResult result = run_command("mesh register " + file_path("moved.ply") + " " + file_path("hand.ply") + " " +
                                             file_path("out.ply") + " --annotations " + file_path("moved.ant.json") +
                                             " --annotations-out " + file_path("out.ant.json") + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    const double uncertainty = report["result"]["rotationUncertainty"].GetDouble();
    EXPECT_GT(uncertainty, 1e-5);
    EXPECT_LT(uncertainty, 0.2);
    EXPECT_LT(report["result"]["placementUncertainty"].GetDouble(), 2e-3 * box_diagonal(from) * 1000);
    EXPECT_EQ(report["result"]["undetermined"].GetInt(), 0);
    const Mesh out = read_mesh(file_path("out.ply")).mesh;
    const AnnotationSet moved_set = read_annotations(file_path("out.ant.json"), out);
    EXPECT_EQ(moved_set.unit, "mm");
    EXPECT_EQ(moved_set.find(4)->faces, part.faces);
    EXPECT_GT(std::abs((*moved_set.up)[2] - 1), 0.01);
    EXPECT_EQ(run_command("mesh register " + file_path("moved.ply") + " " + file_path("hand.ply") + " " + file_path("out.ply") +
                          " --annotations " + file_path("moved.ant.json"))
                  .code,
              2);
}

TEST_F(RegisterCommand, RefusesMirrorImagesAndOtherObjectsAndWritesNothing) {
    for (const auto& [source, words] : {std::pair{"mirror.ply", "mirror image"}, std::pair{"chair.ply", "not the same object"}}) {
        const CommandResult result =
            run_command("mesh register " + file_path(source) + " " + file_path("hand.ply") + " " + file_path("no.ply"));
        EXPECT_EQ(result.code, 3) << source << result.err;
        EXPECT_NE(result.out.find(words), std::string::npos) << result.out;
        EXPECT_FALSE(std::filesystem::exists(scratch / "no.ply"));
    }
}

TEST_F(RegisterCommand, BadInputNamesTheFile) {
    write_file(scratch / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const std::string& files :
         {file_path("flat.obj") + " " + file_path("hand.ply"), file_path("hand.ply") + " " + file_path("flat.obj")}) {
        const CommandResult result = run_command("mesh register " + files);
        EXPECT_EQ(result.code, 1);
        EXPECT_NE(result.err.find("flat.obj"), std::string::npos) << result.err;
    }
    EXPECT_EQ(run_command("mesh register " + file_path("hand.ply") + " " + file_path("hand.ply") + " --tolerance 2").code, 2);
}
