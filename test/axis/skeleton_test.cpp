// Skeletons of coarse meshes and of several bodies.
#include "meshes.h"
#include "ostraka/axis/axis.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <numeric>

namespace ostraka {
namespace {

TriangleSoup box(double x, double y, double z, int n) {
    TriangleSoup soup = test::box(n);
    for (auto& p : soup.points) p = {x * p[0], y * p[1], z * p[2]};
    return soup;
}

std::vector<Index> all_faces(const Mesh& mesh) {
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index{0});
    return faces;
}

TEST(Skeleton, ALongBoxHasAnAxisHoweverCoarse) {
    for (const int n : {1, 2, 8}) {
        const Mesh mesh = build_mesh(box(10, 10, 50, n));
        AxisOptions options;
        options.method = AxisMethod::skeleton;
        const Axis axis = find_axis(mesh, all_faces(mesh), options);
        ASSERT_TRUE(axis.found) << n << ": " << axis.reason;
        EXPECT_GT(axis.direction.z(), 0.99) << n;
        EXPECT_NEAR(axis.point.x(), 5, 1) << n;
        EXPECT_NEAR(axis.point.y(), 5, 1) << n;
        ASSERT_NE(axis.figure("length"), nullptr);
        EXPECT_GT(axis.figure("length")->value, 30) << n;
        EXPECT_TRUE(axis.notes.empty());
    }
}

TEST(Skeleton, BodiesThatAreLeftOutAreNamed) {
    TriangleSoup soup = box(10, 10, 50, 4);
    const auto count = static_cast<Index>(soup.points.size());
    // A small ball of many faces beside the box of few.
    const TriangleSoup ball = test::octahedron_sphere(4);
    for (const auto& p : ball.points) soup.points.push_back({30 + 3 * p[0], 3 * p[1], 3 * p[2]});
    for (const auto& t : ball.triangles) soup.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    const Mesh mesh = build_mesh(soup);
    AxisOptions options;
    options.method = AxisMethod::skeleton;
    const Axis axis = find_axis(mesh, all_faces(mesh), options);
    ASSERT_TRUE(axis.found) << axis.reason;
    EXPECT_GT(axis.direction.z(), 0.99);
    ASSERT_EQ(axis.notes.size(), 1U);
    EXPECT_NE(axis.notes[0].find("2 bodies"), std::string::npos) << axis.notes[0];
    const test::Scratch scratch;
    write_mesh(scratch / "two.ply", mesh);
    const auto result = test::run_command("axis --method skeleton " + (scratch / "two.ply").string());
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("left out"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace ostraka
