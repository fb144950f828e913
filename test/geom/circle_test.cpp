// Known circles, lines, hulls and rectangles.
#include "ostraka/geom/circle.h"
#include "ostraka/geom/line.h"
#include "ostraka/geom/planar.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using Eigen::Vector2d;

namespace {

PlaneSegments arc(double from, double to, double radius, const Vector2d& centre, int pieces) {
    PlaneSegments segments;
    const auto at = [&](int k) {
        const double t = from + (to - from) * k / pieces;
        return Vector2d(centre + radius * Vector2d(std::cos(t), std::sin(t)));
    };
    for (int k = 0; k < pieces; ++k) segments.emplace_back(at(k), at(k + 1));
    return segments;
}

}  // namespace

TEST(CircleFit, OfArcsForAnySubdivisionAndPosition) {
    for (const double scale : {1.0, 1e-6, 1e6})
        for (const double to : {2 * M_PI, 3.0, 0.8}) {
            const Vector2d centre = scale * Vector2d(30, -20);
            const Circle circle = fit_circle(arc(0.3, 0.3 + to, 2 * scale, centre, 400));
            EXPECT_NEAR((circle.centre - centre).norm() / scale, 0, 2e-4) << to;
            EXPECT_NEAR(circle.radius / scale, 2, 2e-4) << to;
        }
    // Halving every piece changes nothing.
    const auto coarse = arc(0, 2.5, 3, {1, 2}, 12);
    PlaneSegments fine;
    for (const auto& [a, b] : coarse) fine.emplace_back(a, a + 0.3 * (b - a)), fine.emplace_back(a + 0.3 * (b - a), b);
    const Circle first = fit_circle(coarse), second = fit_circle(fine);
    EXPECT_NEAR((first.centre - second.centre).norm(), 0, 1e-9);
    EXPECT_NEAR(first.radius, second.radius, 1e-9);
}

TEST(CircleFit, IsTheLeastSquares) {
    // No nearby circle fits better, for a figure that is not a circle.
    const PlaneSegments egg{{{2, 0}, {0, 1.5}}, {{0, 1.5}, {-1.6, 0}}, {{-1.6, 0}, {0, -1.4}}, {{0, -1.4}, {2, 0}}};
    const Circle best = fit_circle(egg);
    const double minimum = circle_deviation(egg, best).square;
    for (const Vector2d& step : {Vector2d(1e-3, 0), Vector2d(-1e-3, 0), Vector2d(0, 1e-3), Vector2d(0, -1e-3)})
        EXPECT_GT(circle_deviation(egg, {best.centre + step, best.radius}).square, minimum);
    for (const double r : {-1e-3, 1e-3}) EXPECT_GT(circle_deviation(egg, {best.centre, best.radius + r}).square, minimum);
}

TEST(ArcFit, RadiusUncertaintyMatchesTheArc) {
    for (const double degrees : {4.6, 30.0, 90.0, 180.0, 330.0}) {
        const ArcFit fit = fit_arc(arc(0.3, 0.3 + degrees * M_PI / 180, 100, {20, -3}, 400));
        EXPECT_NEAR(fit.angle * 180 / M_PI, degrees, 1e-3 * degrees);
        EXPECT_TRUE(fit.is_round()) << degrees;
        EXPECT_NEAR(fit.radius_low, 100, 0.02);
        EXPECT_NEAR(fit.radius_high, 100, 0.02);
    }
    EXPECT_FALSE(fit_arc(PlaneSegments{}).is_round());
    EXPECT_FALSE(fit_arc(PlaneSegments{{{0, 0}, {1, 1}}}).is_round());
    // Sides of a square: not an arc, however well a circle fits.
    const PlaneSegments corner{{{1, 0}, {0, 0}}, {{0, 0}, {0, 1}}};
    EXPECT_FALSE(fit_arc(corner).is_round());
    EXPECT_GT(fit_arc(corner).uncertainty(), 0.3);
}

TEST(ArcFit, IntervalsHaveTheNominalCoverage) {
    // For 200 points with noise s along a short arc of length L the curvature has the standard error s sqrt(720 / n) / L^2; for
    // any arc the intervals contain the radius in 95 of 100 cases, up to the error of 200 draws.
    const int n = 200, draws = 200;
    for (const double degrees : {5.0, 20.0, 90.0, 180.0}) {
        const double noise = degrees < 10 ? 0.02 : 0.3, length = 100 * degrees * M_PI / 180;
        int covered = 0;
        double width = 0;
        for (int draw = 0; draw < draws; ++draw) {
            Random random(11, static_cast<std::uint64_t>(draw));
            std::vector<Vector2d> points;
            for (int k = 0; k < n; ++k) {
                const double a = degrees * M_PI / 180 * k / (n - 1), r = 100 + noise * random.normal();
                points.emplace_back(5 + r * std::cos(a), r * std::sin(a));
            }
            random.shuffle(points);  // in any order
            const ArcFit fit = fit_arc(points);
            EXPECT_TRUE(fit.is_round());
            if (fit.radius_low <= 100 && 100 <= fit.radius_high) ++covered;
            width += (1 / fit.radius_low - 1 / fit.radius_high) / 2 / draws;
        }
        EXPECT_GE(covered, 0.88 * draws) << degrees;
        if (degrees < 30) {
            EXPECT_NEAR(width / (1.96 * noise * std::sqrt(720.0 / n) / length / length), 1, 0.2) << degrees;
        }
    }
}

TEST(AngleCovered, ByPoints) {
    const auto degrees = [](std::vector<double> list) {
        for (double& a : list) a *= M_PI / 180;
        return angle_covered(list) * 180 / M_PI;
    };
    EXPECT_NEAR(degrees({0, 120, 240}), 360, 1e-9);
    EXPECT_NEAR(degrees({0, 5, 10}), 10, 1e-9);  // three points on a short arc are not a circle
    EXPECT_NEAR(degrees({0, 90, 180}), 180, 1e-9);
    std::vector<double> ring, arcs;
    for (int k = 0; k < 90; ++k) ring.push_back(4 * k), arcs.push_back(k < 45 ? k : k + 135);
    EXPECT_NEAR(degrees(ring), 360, 1e-9);
    EXPECT_NEAR(degrees(arcs), 88, 1e-9);  // both gaps count
    EXPECT_EQ(degrees({7}), 0);
    EXPECT_EQ(degrees({}), 0);
}

TEST(CircleFit, OfLinesAndNothing) {
    EXPECT_LT(fit_circle(PlaneSegments{}).radius, 0);
    EXPECT_LT(fit_circle(PlaneSegments{{{0, 0}, {1, 1}}, {{1, 1}, {3, 3}}}).radius, 0);
    EXPECT_LT(fit_circle(PlaneSegments{{{1, 2}, {1, 2}}}).radius, 0);
    EXPECT_EQ(circle_deviation({}, {{0, 0}, 1}).absolute, 0);
}

TEST(CircleDeviation, AlongAStraightPieceThroughTheCircle) {
    // From the centre outward: the mean of |t - 1| over 0 to 2 is 1/2, of its square 1/3.
    const auto d = circle_deviation({{{0, 0}, {2, 0}}}, {{0, 0}, 1});
    EXPECT_NEAR(d.absolute, 0.5, 1e-12);
    EXPECT_NEAR(d.square, 1.0 / 3, 1e-12);
    // Past the centre at a distance: sqrt(t^2 + h^2).
    const double h = 0.01, l = 3, r = 5;
    const double mean = (l * std::hypot(l, h) + h * h * std::asinh(l / h)) / (2 * l);
    EXPECT_NEAR(circle_deviation({{{-l, h}, {l, h}}}, {{0, 0}, r}).absolute, r - mean, 1e-11);
}

TEST(Hull, OfPointsOnALineOnAGridAndOne) {
    EXPECT_TRUE(convex_hull({}).empty());
    EXPECT_EQ(convex_hull({{1, 1}, {1, 1}}).size(), 1U);
    EXPECT_EQ(convex_hull({{0, 0}, {2, 2}, {1, 1}, {3, 3}}).size(), 2U);
    std::vector<Vector2d> grid;
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 5; ++j) grid.emplace_back(0.1 * i, 0.1 * j);
    const auto hull = convex_hull(grid);
    EXPECT_NEAR(polygon_moments(hull, {9, 9}).area, 0.24, 1e-12);
    const auto box = smallest_rectangle(hull);
    EXPECT_NEAR(box.length, 0.6, 1e-12);
    EXPECT_NEAR(box.breadth, 0.4, 1e-12);
    EXPECT_EQ(smallest_rectangle({}).area(), 0);
    EXPECT_EQ(smallest_rectangle({{3, 4}}).centre, Vector2d(3, 4));
    EXPECT_NEAR(smallest_rectangle({{0, 0}, {3, 4}}).length, 5, 1e-12);
    EXPECT_NEAR(smallest_rectangle({{0, 0}, {3, 4}}).breadth, 0, 1e-12);
}

TEST(Rectangle, IsTheSmallestOfAllDirections) {
    std::vector<Vector2d> points;
    unsigned state = 7;
    const auto next = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24); };
    for (int i = 0; i < 200; ++i) points.emplace_back(3 * next() + next(), next());
    const auto box = smallest_rectangle(convex_hull(points));
    double minimum = 1e9;
    for (int k = 0; k < 20000; ++k) {
        const Vector2d a(std::cos(k * M_PI / 20000), std::sin(k * M_PI / 20000)), b(-a.y(), a.x());
        double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
        for (const auto& p : points)
            x0 = std::min(x0, a.dot(p)), x1 = std::max(x1, a.dot(p)), y0 = std::min(y0, b.dot(p)), y1 = std::max(y1, b.dot(p));
        minimum = std::min(minimum, (x1 - x0) * (y1 - y0));
    }
    EXPECT_LE(box.area(), minimum * (1 + 1e-12));
    EXPECT_NEAR(box.area(), minimum, 1e-3 * minimum);
}

TEST(LineFitTest, ThroughPointsWithWeights) {
    const auto fit = fit_line({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1, 5, 1}}, {1, 1, 1, 0});
    EXPECT_NEAR(std::abs(fit.direction.x()), 1, 1e-12);
    EXPECT_NEAR(fit.rms, 0, 1e-9);
    EXPECT_NEAR((fit.point - Eigen::Vector3d(1, 0, 1)).norm(), 0, 1e-12);
}
