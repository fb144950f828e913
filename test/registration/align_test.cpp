#include "ostraka/registration/align.h"

#include "registration/heads.h"

#include "ostraka/core/error.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

Motion nearly(const Motion& truth, double degrees, double shift) {
    Motion start = truth;
    start.rotation =
        Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, Eigen::Vector3d(1, 1, 1).normalized()) * truth.rotation;
    start.translation += Eigen::Vector3d(shift, -shift, 0);
    return start;
}

TEST(Align, FindsTheMotionOfAMovedSurface) {
    const Mesh a = test::head(1, 1).mesh;
    const AlignSurface surface(a);
    const Motion truth = test::motion();
    const AlignSurface other(test::moved(a, truth));
    const Alignment alignment = align(surface, other, {nearly(truth, 10, 2)});
    EXPECT_LT(test::rotation_between(alignment.motion.rotation, truth.rotation), 0.1);
    EXPECT_LT(alignment.distance, 2e-3);
    EXPECT_GT(alignment.overlap, 0.9);
    EXPECT_TRUE(alignment.converged);
}

TEST(Align, MeshesOfOneMouldAreNearerThanThoseOfTwo) {
    const AlignSurface a(test::head(1, 1).mesh), b(test::head(1, 2).mesh), c(test::head(2, 3).mesh);
    const double same_mould = align(a, b, {Motion()}).distance, other_mould = align(a, c, {Motion()}).distance;
    EXPECT_LT(2 * same_mould, other_mould);
    EXPECT_LT(align(a, a, {Motion()}).distance, same_mould);
}

TEST(Align, TheDistanceIsTheSameFromBothSidesAndAtAnyScale) {
    const Mesh a = test::head(1, 1).mesh, b = test::head(1, 2).mesh;
    const double forward = align(AlignSurface(a), AlignSurface(b), {Motion()}).distance;
    const double backward = align(AlignSurface(b), AlignSurface(a), {Motion()}).distance;
    EXPECT_NEAR(forward, backward, 0.1 * forward);
    Motion small;
    small.scale = 1e-4;
    const double scaled = align(AlignSurface(test::moved(a, small)), AlignSurface(test::moved(b, small)), {Motion()}).distance;
    EXPECT_NEAR(forward, scaled, 1e-3 * forward);
}

TEST(Align, ShrinkageIsFoundWhereItIsAllowed) {
    const AlignSurface a(test::head(1, 1).mesh), b(test::moved(test::head(1, 2).mesh, test::motion(0.92)));
    AlignOptions options;
    const double rigid = align(a, b, {nearly(test::motion(1), 5, 1)}, options).distance;
    options.shrinkage = 0.15;
    const Alignment free = align(a, b, {nearly(test::motion(1), 5, 1)}, options);
    EXPECT_NEAR(free.motion.scale, 0.92, 0.02);  // their backs differ
    EXPECT_LT(2 * free.distance, rigid);
    options.shrinkage = 0.05;
    EXPECT_GE(align(a, b, {nearly(test::motion(1), 5, 1)}, options).motion.scale, 0.95 - 1e-12);
}

TEST(Align, UsesPrincipalAxesWithoutAStart) {
    const Motion truth = test::motion();
    const AlignSurface a(test::head(1, 1).mesh), b(test::moved(test::head(1, 1).mesh, truth));
    const Alignment alignment = align(a, b, {});
    EXPECT_LT(test::rotation_between(alignment.motion.rotation, truth.rotation), 1);
    for (const Motion& start : principal_starts(a, b)) EXPECT_NEAR(start.rotation.determinant(), 1, 1e-9);
}

TEST(Align, AMissingPieceChangesLittle) {
    ArchetypeOptions archetype;
    archetype.seed = 1;
    CastOptions cast;
    cast.vertices = 4000;
    cast.seed = 2;
    cast.keep_pose = true;
    const AlignSurface a(test::head(1, 1).mesh), whole(cast_head(head_archetype(archetype), cast).mesh);
    cast.chunk = cast.beard = 1;
    const AlignSurface broken(cast_head(head_archetype(archetype), cast).mesh);
    const double other = align(a, AlignSurface(test::head(2, 3).mesh), {Motion()}).distance;
    const double changed = std::abs(align(a, broken, {Motion()}).distance - align(a, whole, {Motion()}).distance);
    EXPECT_LT(4 * changed, other);
}

TEST(Align, RegistersSurfacesThatSlideOnThemselves) {
    // A ball can rotate on itself: the motion is undetermined, the distance is not.
    const AlignSurface ball(build_mesh(test::octahedron_sphere(4))),
        away(build_mesh(test::moved(test::octahedron_sphere(4), 1, {0.3, 0.1, 0})));
    const Alignment alignment = align(ball, away, {Motion()});
    EXPECT_LT(alignment.distance, 1e-3);
    EXPECT_LT((alignment.motion.rotation * Eigen::Vector3d::Zero() + alignment.motion.translation - Eigen::Vector3d(0.3, 0.1, 0))
                  .norm(),
              1e-2);
}

TEST(Align, RefusesMeshesWithoutArea) {
    EXPECT_THROW(AlignSurface{Mesh()}, Error);
    EXPECT_THROW(AlignSurface(build_mesh(test::octahedron_sphere(1)), 0), Error);
    AlignOptions options;
    options.trim = 0;
    const AlignSurface ball(build_mesh(test::octahedron_sphere(1)));
    EXPECT_THROW((void)align(ball, ball, {}, options), Error);
}

}  // namespace
}  // namespace ostraka
