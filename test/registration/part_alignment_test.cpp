#include "ostraka/registration/part_alignment.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/synthetic/fragments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using Eigen::Vector3d;

Mesh potato(int levels = 5) {
    Mesh mesh = build_mesh(test::octahedron_sphere(levels));
    for (const Vertex v : mesh.vertices()) {
        const Vector3d p = eigen(mesh.point(v));
        mesh.point(v) = point_of((1 + 0.15 * std::sin(3 * p.x() + 1) * std::cos(2 * p.y()) + 0.1 * p.z() * p.x()) *
                                 Vector3d(p.x(), 1.2 * p.y(), 1.8 * p.z()));
    }
    return mesh;
}

Motion nudge(double degrees, const Vector3d& shift) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    motion.translation = shift;
    return motion;
}

double degrees_between(const Motion& a, const Motion& b) {
    return Eigen::AngleAxisd(Eigen::Matrix3d(a.rotation.transpose() * b.rotation)).angle() * 180 / std::numbers::pi;
}

TEST(PartAlignment, ConvergesFromNearby) {
    const Mesh whole = potato();
    const SurfaceSearch search(whole);
    FragmentOptions options;
    options.share = 0.25;
    const SyntheticFragment piece = generate_fragment(whole, Point(0, 0.5, 1.6), options);
    for (const double far : {0.0, 1e5}) {
        Motion away;
        away.translation = far * Vector3d(1, -1, 1);
        const Mesh part = [&] {
            Mesh mesh = piece.mesh;
            for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(away(eigen(mesh.point(v))));
            return mesh;
        }();
        const Motion truth = piece.pose.after(away.inverse());
        const Motion start = nudge(6, Vector3d(0.05, -0.05, 0.03)).after(truth);
        const PartAlignment alignment = align_part(part, {}, search, start);
        EXPECT_TRUE(alignment.converged);
        EXPECT_LT(degrees_between(alignment.pose, truth), 1e-3 + 1e-6 * far);
        EXPECT_LT(alignment.residual, 1e-4);
        EXPECT_GT(alignment.overlap, 0.99);
        EXPECT_EQ(alignment.pose.scale, 1);
    }
}

TEST(PartAlignment, ToleratesNoiseAndMissingSurface) {
    Mesh whole = potato();
    const SurfaceSearch search(whole);
    // The fragment has a bump that the whole does not have.
    Mesh grown = whole;
    for (const Vertex v : grown.vertices()) {
        const Vector3d p = eigen(grown.point(v));
        const double near = (p - Vector3d(0.9, 0, 0.8)).squaredNorm() / 0.05;
        grown.point(v) = point_of(p * (1 + 0.15 * std::exp(-near)));
    }
    FragmentOptions options;
    options.share = 0.4;
    options.noise = 0.002;
    const SyntheticFragment piece = generate_fragment(grown, Point(0.3, 0.3, 1.6), options);
    const PartAlignment alignment = align_part(piece.mesh, {}, search, nudge(5, Vector3d(0.05, 0, 0.05)).after(piece.pose));
    EXPECT_LT(degrees_between(alignment.pose, piece.pose), 0.5);
    for (const Vertex v : piece.mesh.vertices())
        EXPECT_LT((alignment.pose(eigen(piece.mesh.point(v))) - piece.pose(eigen(piece.mesh.point(v)))).norm(), 0.02);
}

// A ball fits in any rotation: anchors decide.
TEST(PartAlignment, AnchorsFixTheSlippableMotions) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    const SurfaceSearch search(ball);
    const SyntheticFragment piece = generate_fragment(ball, Point(0, 0, 1), {});
    const Motion start = nudge(20, Vector3d(0.02, 0.01, 0)).after(piece.pose);
    std::vector<Anchor> anchors;
    for (const Index i : {0U, 20U, 40U})
        anchors.push_back({eigen(piece.mesh.point(Vertex(i))), eigen(ball.point(Vertex(piece.vertices[i])))});
    EXPECT_LT(degrees_between(align_part(piece.mesh, {}, search, start, anchors).pose, piece.pose), 0.01);
    const PartAlignment free = align_part(piece.mesh, {}, search, start);
    EXPECT_LT(free.residual, 0.01);
    EXPECT_GT(degrees_between(free.pose, piece.pose), 5) << "nothing determines the rotation, so none is applied";
}

TEST(PartAlignment, TheSameForAnyNumberOfThreads) {
    const Mesh whole = potato(4);
    const SurfaceSearch search(whole);
    const SyntheticFragment piece = generate_fragment(whole, Point(0, 0, 1.8), {});
    const Motion start = nudge(4, Vector3d(0.02, 0.02, 0.02)).after(piece.pose);
    const int before = threads();
    set_threads(1);
    const PartAlignment alone = align_part(piece.mesh, {}, search, start);
    set_threads(3);
    const PartAlignment many = align_part(piece.mesh, {}, search, start);
    set_threads(before);
    EXPECT_EQ(alone.pose.rotation, many.pose.rotation);
    EXPECT_EQ(alone.pose.translation, many.pose.translation);
}

TEST(PartAlignment, DegenerateParts) {
    const Mesh whole = potato(3);
    const SurfaceSearch search(whole);
    EXPECT_THROW(align_part(Mesh(), {}, search, {}), Error);
    EXPECT_THROW(align_part(whole, std::vector<bool>(3, true), search, {}), Error);
    EXPECT_THROW(align_part(whole, std::vector<bool>(whole.number_of_faces(), false), search, {}), Error);
    // Beyond the search radius of everything: it stays where it is, and reports it.
    Motion away;
    away.translation = Vector3d(100, 0, 0);
    const PartAlignment lost = align_part(whole, {}, search, away);
    EXPECT_EQ(lost.overlap, 0);
    EXPECT_EQ(lost.pose.translation, away.translation);
    // One face.
    std::vector<bool> single_face(whole.number_of_faces(), false);
    single_face[0] = true;
    EXPECT_LE(align_part(whole, single_face, search, {}).residual, 1e-9);
}

}  // namespace
}  // namespace ostraka
