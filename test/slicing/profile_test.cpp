// Profiles and outlines of objects that are known.
#include "ostraka/slicing/profile.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/planar.h"
#include "ostraka/slicing/silhouette.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A bowl of revolution about z at (x, y): wall from the outer profile to the inner one, closed.
TriangleSoup bowl(const std::vector<std::array<double, 2>>& profile, double x, double y) {
    const auto rows = static_cast<Index>(profile.size());
    TriangleSoup soup = grid(90, rows, true, true, [&](double u, double v) {
        const auto& [r, z] = profile[static_cast<std::size_t>(std::lround(v * rows)) % rows];
        return std::array<double, 3>{x + r * std::cos(2 * M_PI * u), y + r * std::sin(2 * M_PI * u), z};
    });
    return soup;
}
/// Outside upwards, inside downwards; a ring without a floor.
const std::vector<std::array<double, 2>> ring{{4, 0}, {5, 1}, {6, 3}, {7, 3.2}, {7, 6}, {6, 6}, {6, 4}, {5, 3}, {4, 1}, {3, 0}};

double area(const std::vector<std::vector<Eigen::Vector2d>>& curves) {
    double sum = 0;
    for (const auto& curve : curves) sum += polygon_moments(curve, curve[0]).area;
    return sum;
}

}  // namespace

TEST(Silhouette, OfSolidsAndHoles) {
    const SliceFrame from_above = slice_frame({0, 0, 0}, {0, 0, 1});
    for (const double scale : {1.0, 1e-6, 1e6}) {
        const auto ball = silhouette(build_mesh(moved(octahedron_sphere(5), scale, {9 * scale, 0, 0})), from_above);
        ASSERT_EQ(ball.size(), 1U);
        EXPECT_NEAR(area(ball) / scale / scale, M_PI, 0.01);
    }
    const auto wheel = silhouette(build_mesh(torus(200, 80)), from_above);
    ASSERT_EQ(wheel.size(), 2U);
    EXPECT_NEAR(area(wheel), 8 * M_PI, 0.05);
    const auto box_from_corner = silhouette(build_mesh(box(2)), slice_frame({0, 0, 0}, {1, 1, 1}));
    ASSERT_EQ(box_from_corner.size(), 1U);
    EXPECT_NEAR(area(box_from_corner), std::sqrt(3.0), 0.01);
    EXPECT_LT(box_from_corner[0].size(), 100U);
    EXPECT_THROW((void)silhouette(Mesh(), from_above), Error);
    EXPECT_THROW((void)silhouette(build_mesh(box(1)), from_above, 3), Error);
}

TEST(Profile, OfARevolvedPotWithAHandle) {
    const Mesh pot = build_mesh(
        joined(bowl(ring, 2, 1), moved(octahedron_sphere(3), 0.8, {2 + 7.5 * std::cos(1.0), 1 + 7.5 * std::sin(1.0), 4})));
    const Profile profile = find_profile(pot, slice_frame({2, 1, 0}, {0, 0, 1}));
    EXPECT_TRUE(profile.is_revolved);
    EXPECT_NEAR(profile.low, 0, 1e-12);
    EXPECT_NEAR(profile.high, 6, 1e-12);
    EXPECT_NEAR(profile.rim_diameter, 14, 0.05);
    EXPECT_EQ(profile.rim_share, 1);
    // The section does not cut the handle, the view shows it on the right.
    EXPECT_GT(std::abs(std::remainder(profile.angle - 1.0, 2 * M_PI)), 0.1);
    EXPECT_NEAR(std::remainder(profile.view_angle - 1.0, 2 * M_PI), 0, 0.1);
    double left = 0, right = 0;
    for (const auto& curve : profile.outline)
        for (const auto& p : curve) left = std::min(left, p.x()), right = std::max(right, p.x());
    EXPECT_NEAR(right, 8.3, 0.05);
    EXPECT_NEAR(left, -7, 0.05);
    // Both walls, each with the area of the profile.
    ASSERT_EQ(profile.section.contours.size(), 2U);
    double expected = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
        expected += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    for (const auto& contour : profile.section.contours) EXPECT_NEAR(contour.area, expected, 0.01 * expected);
    // The shoulder at 3.2 is an edge.
    EXPECT_TRUE(std::any_of(profile.edges.begin(), profile.edges.end(), [](const Profile::Edge& e) {
        return std::abs(e.height - 3.1) < 0.2 && std::abs(e.radius - 6.8) < 0.5;
    }));
    // The direction can be chosen.
    EXPECT_EQ(find_profile(pot, slice_frame({2, 1, 0}, {0, 0, 1}), 0.3).angle, 0.3);
}

TEST(Profile, OfObjectsThatAreNotRevolvedOrOpen) {
    const Profile cube = find_profile(build_mesh(box(3)), slice_frame({0.5, 0.5, 0}, {0, 0, 1}));
    EXPECT_EQ(cube.rim_diameter, 0);  // no mouth
    const Profile open = find_profile(build_mesh(tube(60, 10)), slice_frame({0, 0, 0}, {0, 0, 1}));
    EXPECT_NEAR(open.rim_diameter, 2, 0.01);
    for (const auto& contour : open.section.contours) EXPECT_FALSE(contour.closed);
    EXPECT_THROW((void)find_profile(Mesh(), slice_frame({0, 0, 0}, {0, 0, 1})), Error);
}

TEST(Profile, OfPartsThatProtrudeAboveAndBesideTheWall) {
    // An arched handle over the rim, no wider than the belly, in the plane at 40 degrees.
    const double turn = 40 * M_PI / 180;
    const TriangleSoup arch = grid(60, 24, false, true, [&](double u, double v) {
        const double along = M_PI * u, around = 2 * M_PI * v, r = 5 + 0.4 * std::cos(around);
        const double x = r * std::cos(along), y = 0.4 * std::sin(around);
        return std::array<double, 3>{2 + x * std::cos(turn) - y * std::sin(turn), 1 + x * std::sin(turn) + y * std::cos(turn),
                                     6 + r * std::sin(along)};
    });
    const SliceFrame axis = slice_frame({2, 1, 0}, {0, 0, 1});
    const Profile basket = find_profile(build_mesh(joined(bowl(ring, 2, 1), arch)), axis);
    EXPECT_NEAR(basket.high, 11.4, 0.01);
    ASSERT_TRUE(basket.is_revolved);
    EXPECT_NEAR(std::remainder(basket.view_angle - turn, M_PI), 0, 0.1);
    EXPECT_FALSE(basket.hides);
    // On both sides of the axis, as far as it reaches.
    double left = 0, right = 0;
    for (const auto& curve : basket.outline)
        for (const auto& p : curve)
            if (p.y() > 6.5 && p.y() < 7.5) left = std::min(left, p.x()), right = std::max(right, p.x());
    EXPECT_NEAR(right, 5.38, 0.1);
    EXPECT_NEAR(left, -5.38, 0.1);
    EXPECT_NEAR(basket.extent_at(4.5), 7, 0.1);
    EXPECT_EQ(basket.extent_at(12), 0);
    // Two knobs at a right angle: the view along one hides it.
    TriangleSoup knobs =
        joined(moved(octahedron_sphere(3), 0.8, {2 + 7.5, 1, 4}), moved(octahedron_sphere(3), 0.7, {2, 1 + 7.5, 4}));
    const Profile two = find_profile(build_mesh(joined(bowl(ring, 2, 1), knobs)), axis);
    EXPECT_TRUE(two.hides);
}
