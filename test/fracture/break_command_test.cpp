#include "meshes.h"
#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {
namespace {

using test::run_command;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

TEST(BreakCommand, TheCentreIsAPointOrATag) {
    const test::Scratch scratch;
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    write_mesh(scratch / "ball.ply", ball);
    AnnotationSet set;
    set.annotations.emplace_back();
    set.annotations[0].tag = "head";
    set.annotations[0].faces = {0, 1, 2};
    write_annotations(scratch / "ball.ant.json", {ball, set}, "ball.ply", {});
    const Path piece = scratch / "piece.ply", annotations = scratch / "piece.ant.json";
    const std::string command = "mesh break " + quoted(scratch / "ball.ply") + " " + quoted(piece),
                      annotated = command + " --annotations " + quoted(scratch / "ball.ant.json"),
                      out = " --annotations-out " + quoted(annotations);
    const auto unknown = run_command(annotated + " --at nope");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("no annotation has this tag"), std::string::npos) << unknown.err;
    EXPECT_NE(unknown.err.find("0,0,10"), std::string::npos) << unknown.err;
    const auto bare = run_command(command + " --at nope");
    EXPECT_EQ(bare.code, 2);
    EXPECT_NE(bare.err.find("0,0,10"), std::string::npos) << bare.err;
    EXPECT_EQ(run_command(annotated + " --at 0,0,1").code, 2) << "annotations for nothing";
    EXPECT_EQ(run_command(command + " --at 0,0,1" + out).code, 2) << "none to take them from";
    EXPECT_FALSE(std::filesystem::exists(piece));
    const auto by_tag = run_command(annotated + " --at head");
    EXPECT_EQ(by_tag.code, 0) << by_tag.err;
    EXPECT_TRUE(std::filesystem::exists(piece));
    EXPECT_FALSE(std::filesystem::exists(annotations));
    EXPECT_EQ(run_command(annotated + out + " --at head").code, 0);
    EXPECT_EQ(read_annotations(annotations, read_mesh(piece).mesh).annotations.at(0).tag, "head");
}

}  // namespace
}  // namespace ostraka
