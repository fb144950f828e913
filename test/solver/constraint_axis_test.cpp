// Axes that rotate by the minimum angle, and mirrored partners.
#include "outcome.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// The minimum squared distance of rotated rows with the axis at an angle to a direction, by trying all rotations.
double min_by_trying(const Points& rows, const Vector3d& axis, const Vector3d& direction, double wanted) {
    double minimum = std::numeric_limits<double>::infinity();
    constexpr int steps = 120;
    const Vector3d e1 = direction.unitOrthogonal();
    const auto rotation = [](int i, const Vector3d& about) {
        return Eigen::AngleAxisd(2 * std::numbers::pi * i / steps, about).toRotationMatrix();
    };
    for (const double side : {1.0, -1.0})
        for (int i = 0; i < steps; ++i) {
            const Vector3d to = std::cos(wanted) * side * direction + std::sin(wanted) * (rotation(i, direction) * e1);
            const Matrix3d first = Eigen::Quaterniond::FromTwoVectors(axis, to).toRotationMatrix();
            for (int j = 0; j < steps; ++j) minimum = std::min(minimum, (rotation(j, to) * first * rows - rows).squaredNorm());
        }
    return minimum;
}

TEST(Constraint, LevelsWeighTheirPoints) {
    Points points(3, 4);
    points << 0, 1, 5, 6, 0, 0, 0, 0, 0, 4, 1, 2;
    kinds::MeansOnLevel kind{{0, 0, 1}, {0, 0, 1, 1}, {3, 1, 2, 2}};  // heights 1 and 1.5
    const auto level = make_constraint(kind, {0, 1, 2, 3}, 1, points);
    EXPECT_NEAR(level->squared_distance(points), 2 * 0.25 * 0.25, 1e-12);
    kind.weights = {3, 1};
    EXPECT_THROW(make_constraint(kind, {0, 1, 2, 3}, 1, points), Error);
    kind.weights = {3, 1, 0, 2};
    EXPECT_THROW(make_constraint(kind, {0, 1, 2, 3}, 1, points), Error);
}

TEST(Constraint, AxesDoNotCollapseToAPoint) {
    Points rest = random_points(20, 6);
    kinds::AxisDirection kind{{0, 0, 1}, {0, 0}, Vector3d(0, 0, 1)};
    const std::vector<int> ids = first_ids(20);
    const Points small = 0.1 * rest;
    EXPECT_NEAR(make_constraint(kind, ids, 1, rest)->squared_distance(small), 0, 1e-12);
    kind.min_size = rest;
    const auto bounded = make_constraint(kind, ids, 1, rest);
    EXPECT_NEAR(bounded->squared_distance(rest), 0, 1e-12);
    EXPECT_NEAR(bounded->squared_distance(0.6 * rest), 0, 1e-12);
    const double size = (rest.colwise() - rest.rowwise().mean().eval()).norm();
    EXPECT_NEAR(std::sqrt(bounded->squared_distance(small)), 0.4 * size, 1e-9);
}

TEST(Constraint, AxesRotateByTheMinimumAngle) {
    // Rods, plates and blocks with known axis, rotated arbitrarily, and exactly parallel and perpendicular to the direction.
    const Vector3d d = Vector3d(1, -2, 3).normalized();
    for (const Vector3d& size :
         {Vector3d(1, 1, 4), Vector3d(1, 2, 4), Vector3d(1, 0, 3), Vector3d(3, 3, 0.5), Vector3d(2, 2, 2)}) {
        Points rest = random_points(30, 6);
        rest.colwise() -= rest.rowwise().mean().eval();
        rest = size.asDiagonal() * rest;
        for (const Vector3d& axis : {Vector3d(0, 0, 1), Vector3d(0.6, 0, 0.8)})
            for (int place = 0; place < 4; ++place) {
                Matrix3d rotation = some_rotation();
                if (place == 1) rotation = Eigen::Quaterniond::FromTwoVectors(axis, d).toRotationMatrix();
                if (place == 2) rotation = Eigen::Quaterniond::FromTwoVectors(axis, d.unitOrthogonal()).toRotationMatrix();
                if (place == 3)
                    rotation = Eigen::Quaterniond::FromTwoVectors(axis, -d + 1e-7 * d.unitOrthogonal()).toRotationMatrix();
                const Points rows = rotation * rest;
                for (const double wanted : {0.0, 1e-4, 0.3, 1.2, std::numbers::pi / 2}) {
                    const auto c = make_constraint(kinds::AxisDirection{d, {wanted, wanted}, axis}, first_ids(30), 1, rest);
                    const Outcome o = outcome(*c, rows);
                    const std::string name = testing::PrintToString(size.transpose().eval()) + " place " + std::to_string(place) +
                                             " angle " + std::to_string(wanted);
                    const Matrix3d best = Eigen::umeyama(rows, o.projected, false).topLeftCorner<3, 3>();
                    ASSERT_LT((best * rows - o.projected).norm(), 1e-10) << name;
                    const double angle_there = angle(best * rotation * axis, d);
                    ASSERT_NEAR(std::min(angle_there, std::numbers::pi - angle_there), wanted, 2e-8) << name;
                    const double minimum = min_by_trying(rows, rotation * axis, d, wanted),
                                 reached = (o.rows - o.projected).squaredNorm();
                    ASSERT_LE(reached, minimum + 1e-9 * rows.squaredNorm()) << name;
                    ASSERT_LT((again(*c, o.projected) - o.projected).norm(), 1e-7) << name;
                }
            }
    }
}

TEST(Constraint, AxesInRangeAreUnchanged) {
    const Points rest = random_points(9, 12);
    const auto residual = [&](const kinds::Interval& range) {  // for an axis at pi / 4
        const kinds::AxisDirection kind{{0, 0, 1}, range, Vector3d(1, 0, 1)};
        return make_constraint(kind, first_ids(9), 1, rest)->residual(rest);
    };
    EXPECT_EQ(residual({0.7, 0.8}), 0);
    EXPECT_EQ(residual({0, 0.8}), 0);
    EXPECT_EQ(residual({0.7, std::numbers::pi / 2}), 0);
    EXPECT_GT(residual({0, 0}), 0.1);
}

TEST(Constraint, PartnersInTrianglesMirror) {
    // A point and a triangle on the other side of x = 1, with the mirror image of the point at (3, 0.25, 0.25), up to a bump.
    Points rest(3, 4);
    rest.col(0) << -1, 0.25, 0.25;
    rest.col(1) << 3, 0, 0;
    rest.col(2) << 3, 1, 0;
    rest.col(3) << 3, 0, 1;
    kinds::MirrorInTriangles kind{{{2, 0, 0}, {1, 7, 7}}, {0.5, 0.25, 0.25}};
    const auto exact = make_constraint(kind, first_ids(4), 1, rest);
    EXPECT_LT(exact->residual(rest), 1e-15);
    Points bumped = rest;
    bumped.col(0) += Vector3d(-0.4, 0.2, 0.6);
    // Each side moves by half of it.
    const Outcome o = outcome(*exact, bumped);
    EXPECT_LT((o.projected.col(0) - Vector3d(-1.2, 0.35, 0.55)).norm(), 1e-15);
    EXPECT_LT((o.projected.col(1) - Vector3d(3.2, 0.35, 0.55)).norm(), 1e-15);
    // Deviations at rest are preserved.
    const Points off = Vector3d(0.4, 0.2, 0.6);
    kind.discrepancies = off;
    const auto nearly = make_constraint(kind, first_ids(4), 1, bumped);
    EXPECT_LT(nearly->residual(bumped), 1e-15);
    EXPECT_NEAR(nearly->residual(rest), off.norm(), 1e-15);
    exact->set_target(off);
    EXPECT_LT(exact->residual(bumped), 1e-15);
    EXPECT_THROW(exact->set_target(bumped), Error);
}

}  // namespace
}  // namespace ostraka
