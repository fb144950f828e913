// Axes that normals intersect, for surfaces with known axis.
#include "ostraka/geom/line_complex.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using Eigen::Vector3d;

namespace {

Motion some_motion() {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(0.8, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    motion.translation = {3, -1, 2};
    return motion;
}

/// Points and normals of a cone about z with this slope.
std::vector<std::pair<Vector3d, Vector3d>> cone(double slope, double from, double to) {
    std::vector<std::pair<Vector3d, Vector3d>> list;
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 10; ++k) {
            const double t = from + (to - from) * i / 19, z = k / 9.0, r = 1 + slope * z;
            const Vector3d out(std::cos(t), std::sin(t), 0);
            list.emplace_back(r * out + z * Vector3d::UnitZ(), (out - slope * Vector3d::UnitZ()).normalized());
        }
    return list;
}

LineComplex complex_of(const std::vector<std::pair<Vector3d, Vector3d>>& list, const Motion& motion = {}) {
    LineComplex complex;
    for (const auto& [place, normal] : list) complex.add(motion(place), motion.rotation * normal);
    return complex;
}

}  // namespace

TEST(LineComplex, FindsTheAxisOfAPartOfACone) {
    const Motion motion = some_motion();
    const LineComplex complex = complex_of(cone(0.4, 0, 1), motion);
    const LineComplex::Axis axis = complex.solve();
    const Vector3d direction = motion.rotation * Vector3d::UnitZ();
    EXPECT_NEAR(std::abs(axis.direction.dot(direction)), 1, 1e-9);
    EXPECT_NEAR((motion(Vector3d::Zero()) - axis.place).cross(direction).norm(), 0, 1e-6);
    EXPECT_NEAR(complex.off_axis(), 0, 1e-6);
}

TEST(LineComplex, TransformsWithTheNormals) {
    Random random(3);
    std::vector<std::pair<Vector3d, Vector3d>> list;
    for (int k = 0; k < 50; ++k) {
        const auto any = [&] { return Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
        list.emplace_back(any(), any().normalized());
    }
    const Motion motion = some_motion();
    const LineComplex moved = complex_of(list).moved(motion), recomputed = complex_of(list, motion);
    EXPECT_NEAR(moved.off_axis(), recomputed.off_axis(), 1e-9);
    EXPECT_NEAR(std::abs(moved.solve().direction.dot(recomputed.solve().direction)), 1, 1e-8);
}

TEST(LineComplex, OnlyMatchingPartsShareAnAxis) {
    const LineComplex left = complex_of(cone(0.4, 0, 1)), right = complex_of(cone(0.4, 1, 2));
    LineComplex together = left;
    together.add(right);
    EXPECT_LT(together.off_axis(), 1e-6);
    Motion tilt;
    tilt.rotation = Eigen::AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix();
    LineComplex apart = left;
    apart.add(right.moved(tilt));
    EXPECT_GT(apart.off_axis(), 0.01);
}

TEST(LineComplex, IsFiniteForEmptyAndPlanarInput) {
    EXPECT_EQ(LineComplex().off_axis(), 0);
    LineComplex plane;
    for (int k = 0; k < 9; ++k) plane.add(Vector3d(k % 3, k / 3, 0), Vector3d::UnitZ());
    EXPECT_TRUE(std::isfinite(plane.off_axis()));
    EXPECT_NEAR(plane.off_axis(), 0, 1e-9);
}
