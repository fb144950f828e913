// Medial axes that are known: segments, diagonals, circles, points; levels that nest.
#include "ostraka/slicing/medial_axis.h"

#include "ostraka/core/error.h"
#include "prisms.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Slice figure(const std::vector<Polygon>& polygons) {
    return slice_mesh(walls(polygons), slice_frame({0, 0, 0}, {0, 0, 1}), {0.5}).slices.at(0);
}

}  // namespace

TEST(MedialAxis, OfARectangle) {
    for (const double scale : {1.0, 1e-6, 1e6})
        for (const double angle : {0.0, 0.6}) {
            const auto slice = figure({transformed(rectangle(4, 2), scale, angle, {7 * scale, scale})});
            const auto axis = medial_axis(slice, {0.01, 0.06});
            ASSERT_EQ(axis.levels.size(), 2U);
            // The middle line, and four diagonals as far as (2 - sqrt 2) t / 12 >= 0.01 at distance t from the corner.
            const double cut = 0.01 * 12 / (2 - std::sqrt(2.0));
            EXPECT_NEAR(axis.levels[1].length / scale, 2, 0.05);
            EXPECT_NEAR(axis.levels[0].length / scale, 2 + 4 * std::sqrt(2.0) * (1 - cut), 0.1);
            ASSERT_EQ(axis.levels[1].branches.size(), 1U);
            EXPECT_EQ(axis.levels[0].branches.size(), 5U);
            for (const double r : axis.levels[1].branches[0].radii) EXPECT_NEAR(r / scale, 1, 0.02);
        }
}

TEST(MedialAxis, OfAnEllipseADiscAndARing) {
    // The segment between the centres of curvature of the far ends.
    const auto oval = medial_axis(figure({ellipse(800, 3, 2)}), {0.002});
    EXPECT_NEAR(oval.levels[0].length, 2 * (9.0 - 4) / 3, 0.5);
    for (const auto& branch : oval.levels[0].branches)
        for (const auto& p : branch.points) EXPECT_NEAR(p.y(), 0, 0.01);
    const auto disc = medial_axis(figure({ellipse(300, 2, 2, {5, 6})}), {0.05});
    ASSERT_EQ(disc.levels[0].branches.size(), 1U);
    EXPECT_LT(disc.levels[0].length, 1e-3);
    EXPECT_NEAR((disc.levels[0].branches[0].points[0] - Eigen::Vector2d(5, 6)).norm(), 0, 1e-6);
    EXPECT_NEAR(disc.levels[0].branches[0].radii[0], 2, 1e-3);
    const auto ring = medial_axis(figure({ellipse(500, 3, 3), reversed(ellipse(400, 1, 1))}), {0.01, 1});
    for (const auto& level : ring.levels) {
        EXPECT_NEAR(level.length, 4 * M_PI, 0.1);
        for (const auto& branch : level.branches)
            for (std::size_t i = 0; i < branch.points.size(); ++i) {
                EXPECT_NEAR(branch.points[i].norm(), 2, 0.01);
                EXPECT_NEAR(branch.radii[i], 1, 0.01);
            }
    }
    // The loop is one closed branch.
    ASSERT_EQ(ring.levels[1].branches.size(), 1U);
    EXPECT_EQ(ring.levels[1].branches[0].points.front(), ring.levels[1].branches[0].points.back());
}

TEST(MedialAxis, LevelsNestAndDiscsLieInside) {
    const Polygon star{{0, 0}, {5, 1}, {9, 0}, {7, 4}, {9, 9}, {4, 7}, {0, 9}, {2, 4}};
    const auto axis =
        medial_axis(figure({star, reversed(rectangle(1, 1, {4, 4})), rectangle(3, 1, {20, 0})}), {0.3, 0.005, 0.05});
    ASSERT_EQ(axis.levels.size(), 3U);
    EXPECT_LT(axis.levels[0].length, axis.levels[2].length);
    EXPECT_LT(axis.levels[2].length, axis.levels[1].length);
    const auto sorted_points = [](const MedialAxis::Level& level) {
        std::vector<std::pair<double, double>> points;
        for (const auto& branch : level.branches)
            for (const auto& p : branch.points) points.emplace_back(p.x(), p.y());
        std::sort(points.begin(), points.end());
        return points;
    };
    const auto fine = sorted_points(axis.levels[1]), middle = sorted_points(axis.levels[2]),
               coarse = sorted_points(axis.levels[0]);
    for (const auto& p : middle) EXPECT_TRUE(std::binary_search(fine.begin(), fine.end(), p));
    for (const auto& p : coarse) EXPECT_TRUE(std::binary_search(middle.begin(), middle.end(), p));
    // No corner lies within a disc.
    for (const auto& branch : axis.levels[1].branches)
        for (std::size_t i = 0; i < branch.points.size(); ++i)
            for (const auto& corner : star) EXPECT_GE((corner - branch.points[i]).norm(), branch.radii[i] * (1 - 1e-9));
}

TEST(MedialAxis, OfAnEmptySlice) {
    const auto empty_axis = medial_axis(Slice{}, {0.1});
    ASSERT_EQ(empty_axis.levels.size(), 1U);
    EXPECT_TRUE(empty_axis.levels[0].branches.empty());
    EXPECT_THROW((void)medial_axis(Slice{}, {0}), Error);
    EXPECT_THROW((void)medial_axis(Slice{}, {std::nan("")}), Error);
    EXPECT_THROW((void)medial_axis(Slice{}, {0.1}, 3), Error);
}
