#include "ostraka/transfer/misalignment.h"

#include "meshes.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/synthetic/make_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using ostraka::test::octahedron_sphere;

namespace {

Mesh object_mesh(const std::string& name, std::uint64_t vertices) {
    MakeOptions options;
    options.vertices = vertices;
    return make_mesh(synthetic_object(name), options).mesh;
}

Misalignment between(const Mesh& source, const Mesh& target) {
    const SurfaceSearch search(target);
    return find_misalignment(source, search);
}

/// Rotated about an axis through the middle of its box, then scaled about it, then moved by a share of the diagonal.
Mesh placed(Mesh mesh, double degrees, const Vector& axis, double scale, const Vector& shift) {
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const double diagonal = box_diagonal(mesh), angle = degrees * CGAL_PI / 180;
    const Point middle((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    for (const Vertex v : mesh.vertices()) {
        const Vector p = mesh.point(v) - middle;
        const Vector turned =
            std::cos(angle) * p + std::sin(angle) * CGAL::cross_product(axis, p) + (1 - std::cos(angle)) * (axis * p) * axis;
        mesh.point(v) = middle + scale * turned + diagonal * shift;
    }
    return mesh;
}

}  // namespace

TEST(Misalignment, ResolutionsOfOneSurfaceAreNotReported) {
    for (const char* name : {"teapot", "vase", "chair", "hand", "statuette"}) {
        const Mesh coarse = object_mesh(name, 2500), fine = object_mesh(name, 8000);
        EXPECT_FALSE(between(coarse, fine).is_significant) << name;
        EXPECT_FALSE(between(fine, coarse).is_significant) << name;
        EXPECT_LT(between(fine, fine).distance, 1e-12 * box_diagonal(fine)) << name;
    }
    for (const int level : {1, 2, 3, 4})
        for (const int other : {1, 2, 3, 4, 5})
            EXPECT_FALSE(between(build_mesh(octahedron_sphere(level)), build_mesh(octahedron_sphere(other))).is_significant)
                << level << ' ' << other;
}

TEST(Misalignment, SmallMotionsAreFound) {
    const Mesh coarse = object_mesh("teapot", 2000), fine = object_mesh("teapot", 6000);
    const double diagonal = box_diagonal(coarse);
    for (const Vector& axis : {Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)}) {
        const Misalignment turned = between(coarse, placed(fine, 3, axis, 1, {0, 0, 0}));
        ASSERT_TRUE(turned.is_significant) << axis;
        EXPECT_NEAR(turned.rotation, 3, 0.3) << axis;
        EXPECT_NEAR(turned.scale, 1, 0.005) << axis;
        const Misalignment moved = between(coarse, placed(fine, 0, axis, 1, 0.01 * axis));
        ASSERT_TRUE(moved.is_significant) << axis;
        EXPECT_NEAR(moved.shift, 0.01 * diagonal, 0.001 * diagonal) << axis;
    }
    for (const double scale : {0.95, 1.05}) {
        const Misalignment scaled = between(coarse, placed(fine, 0, {0, 0, 1}, scale, {0, 0, 0}));
        ASSERT_TRUE(scaled.is_significant) << scale;
        EXPECT_NEAR(scaled.scale, scale, 0.005) << scale;
        EXPECT_GT(scaled.distance, 3 * scaled.distance_left) << scale;
        EXPECT_NE(message_about(scaled, diagonal, "mm").find(" mm apart on average"), std::string::npos);
    }
}

TEST(Misalignment, IsTheSameForAnyNumberOfThreads) {
    const Mesh coarse = object_mesh("teapot", 2000), turned = placed(object_mesh("teapot", 4000), 3, {1, 0, 0}, 1, {0, 0, 0});
    set_threads(1);
    const Misalignment single_threaded = between(coarse, turned);
    set_threads(2);
    const Misalignment two_threaded = between(coarse, turned);
    set_threads(0);
    EXPECT_EQ(single_threaded.distance, two_threaded.distance);
    EXPECT_EQ(single_threaded.distance_left, two_threaded.distance_left);
    EXPECT_EQ(single_threaded.rotation, two_threaded.rotation);
}
