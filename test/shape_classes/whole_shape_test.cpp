#include "ostraka/shape_classes/whole_shape.h"

#include "ostraka/core/angles.h"
#include "ostraka/synthetic/make_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

Mesh synthetic_mesh(const char* name) {
    MakeOptions options;
    options.vertices = 4000;
    return make_mesh(synthetic_object(name), options).mesh;
}

TEST(WholeShape, OfABall) {
    const WholeShape ball = measure_whole_shape(synthetic_mesh("sphere"));
    EXPECT_NEAR(ball.compactness.value(), 1, 0.01);
    EXPECT_NEAR(ball.hull_share.value(), 1, 0.001);
    EXPECT_NEAR(ball.hull_compactness.value(), 1, 0.01);
    EXPECT_NEAR(ball.curvature.value(), 2 * std::sqrt(pi), 0.02);
    EXPECT_LT(ball.concave.value(), 0.01);
    EXPECT_NEAR(ball.saddles.value(), 1, 0.05);
    ASSERT_EQ(ball.spectrum.size(), 12U);
    EXPECT_NEAR(ball.spectrum.front(), 8 * pi, 0.5) << "linear elements are a little stiff";
}

TEST(WholeShape, OfATorus) {
    const WholeShape torus = measure_whole_shape(synthetic_mesh("torus"));
    EXPECT_NEAR(torus.saddles.value(), 2, 0.1) << "4 pi outside, 4 pi inside";
    EXPECT_LT(torus.hull_share.value(), 0.95);
}

TEST(WholeShape, OfAnOpenSurface) {
    Mesh open = synthetic_mesh("sphere");
    open.collect_garbage();
    CGAL::Euler::remove_face(open.halfedge(Face(0)), open);
    open.collect_garbage();
    const WholeShape shape = measure_whole_shape(open);
    EXPECT_FALSE(shape.compactness || shape.hull_share || shape.curvature || shape.concave || shape.saddles);
    EXPECT_TRUE(shape.geodesic_mean.has_value());
    EXPECT_EQ(shape.spectrum.size(), 12U) << "borders are free";
}

TEST(WholeShape, IsInvariantUnderSizeAndPosition) {
    Mesh vase = synthetic_mesh("vase");
    const WholeShape original = measure_whole_shape(vase);
    for (Point& p : vase.points()) p = Point(3 * p.y() + 100, -3 * p.x(), 3 * p.z() - 7);
    const WholeShape moved_shape = measure_whole_shape(vase);
    EXPECT_NEAR(*moved_shape.hull_share / *original.hull_share, 1, 0.01);
    EXPECT_NEAR(*moved_shape.curvature / *original.curvature, 1, 0.05);
    for (std::size_t k = 0; k < original.spectrum.size(); ++k)
        EXPECT_NEAR(moved_shape.spectrum[k] / original.spectrum[k], 1, 0.05) << k;
}

}  // namespace
}  // namespace ostraka
