// Properties of every kind of constraint, and invalid arguments.
#include "outcome.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

TEST(Constraint, EveryKindHasAnExample) {
    const auto list = examples();
    for (std::size_t kind = 0; kind < std::variant_size_v<ConstraintKind>; ++kind)
        EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const Example& e) { return e.kind.index() == kind; })) << kind;
}

TEST(Constraint, ProjectingTwiceIsProjectingOnce) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        const Outcome o = outcome(*c, e.points);
        EXPECT_LT((again(*c, o.projected) - o.projected).cwiseAbs().maxCoeff(), 1e-9) << e.name;
    }
}

TEST(Constraint, ExamplesViolateTheirConstraint) {
    for (const Example& e : examples()) EXPECT_GT(make(e)->residual(e.points), 1e-3) << e.name;
}

TEST(Constraint, NoAdmissibleRowsFoundBySearchAreCloser) {
    for (const Example& e : examples()) {
        if (!e.closest) continue;
        const auto c = make(e);
        const Outcome o = outcome(*c, e.points);
        const double best = squared_distance(*c, o.rows, o.projected);
        unsigned seed = 1000;
        for (const double size : {1e-3, 1e-2, 0.1, 0.3, 1.0, 3.0})
            for (int i = 0; i < 150; ++i) {
                const Points noise = random_points(static_cast<int>(e.points.cols()), seed++, size);
                Points rows;
                c->rows_of(noise, rows);
                for (const Points& from : {Points(o.rows + rows), Points(o.projected + rows)}) {
                    const Points other = again(*c, from);
                    ASSERT_GE(squared_distance(*c, o.rows, other), best - 1e-9) << e.name << " noise " << size;
                }
            }
    }
}

TEST(Constraint, MovesWithItsPoints) {
    const Matrix3d rotation = some_rotation();
    const Vector3d by(3, -2, 5);
    for (const Example& e : examples()) {
        const Matrix3d turn = e.rotates ? rotation : Matrix3d::Identity();
        const Example moved_example = moved(e, turn, by);
        const auto c = make(e), d = make(moved_example);
        const Outcome o = outcome(*c, e.points), p = outcome(*d, moved_example.points);
        const Eigen::VectorXd sums = matrix_of(*c).rowwise().sum();
        EXPECT_LT((turn * o.projected + by * sums.transpose() - p.projected).cwiseAbs().maxCoeff(), 1e-8) << e.name;
        EXPECT_NEAR(c->residual(e.points), d->residual(moved_example.points), 1e-8) << e.name;
    }
}

TEST(Constraint, ResidualIsTheSameFarFromTheOrigin) {
    for (const Example& e : examples()) {
        const Example moved_example = moved(e, Matrix3d::Identity(), Vector3d(1e6, -1e6, 2e6));
        EXPECT_NEAR(make(e)->residual(e.points), make(moved_example)->residual(moved_example.points), 1e-7) << e.name;
    }
}

TEST(Constraint, RowsMatchTheMap) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        Points selected(3, static_cast<Eigen::Index>(e.ids.size()));
        for (Eigen::Index i = 0; i < selected.cols(); ++i) selected.col(i) = e.points.col(e.ids[static_cast<std::size_t>(i)]);
        EXPECT_LT((outcome(*c, e.points).rows - selected * matrix_of(*c).transpose()).cwiseAbs().maxCoeff(), 1e-12) << e.name;
        EXPECT_EQ(c->map().rows - c->map().direct > 0, !c->map().entries.empty()) << e.name;
    }
}

TEST(Constraint, CentredRowsStayCentred) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        if (!c->map().centred) continue;
        { EXPECT_LT(outcome(*c, e.points).projected.leftCols(c->map().direct).rowwise().mean().norm(), 1e-9) << e.name; }
    }
}

TEST(Constraint, MomentsAgreeWithTheProjection) {
    int count = 0;
    for (const Example& e : examples()) {
        const auto c = make(e);
        if (!c->by_moments()) continue;
        ++count;
        const Outcome o = outcome(*c, e.points);
        Constraint::Moments moments{o.rows * o.rows.transpose(), Matrix3d::Zero()};
        Points q = Points::Zero(3, o.rows.cols());
        if (c->reference().cols() > 0) q = c->reference();
        moments.reference = o.rows * q.transpose();
        const auto p = c->project_moments(moments);
        EXPECT_LT((p.of_rows * o.rows + p.of_reference * q - o.projected).cwiseAbs().maxCoeff(), 1e-12) << e.name;
    }
    EXPECT_GE(count, 8);
}

TEST(Constraint, DegeneratePointsGiveNumbers) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        std::vector<std::pair<std::string, Points>> cases;
        cases.emplace_back("one place", Points::Zero(3, e.points.cols()));
        cases.emplace_back("one place elsewhere", Vector3d(1, 2, 3).replicate(1, e.points.cols()));
        cases.emplace_back("on a line", Vector3d(1, 2, 3) * e.points.row(0));
        Points flat = e.points;
        flat.row(2).setZero();
        cases.emplace_back("in a plane", flat);
        Points twice = e.points;
        twice.col(1) = twice.col(0);
        cases.emplace_back("two at one place", twice);
        cases.emplace_back("small", e.points * 1e-90);
        cases.emplace_back("large", e.points * 1e90);
        for (const auto& [name, points] : cases) {
            const Outcome o = outcome(*c, points);
            EXPECT_TRUE(o.projected.allFinite()) << e.name << ", " << name;
            const double largest = std::max(1.0, points.cwiseAbs().maxCoeff());
            EXPECT_LT(o.projected.cwiseAbs().maxCoeff(), 1e3 * largest) << e.name << ", " << name;
        }
    }
}

TEST(Constraint, RefusesInvalidArguments) {
    const Points rest = random_points(8, 5);
    const auto refused = [&](const ConstraintKind& kind, const std::vector<int>& ids, double weight = 1) {
        const std::string name(name_of(kind));
        try {
            make_constraint(kind, ids, weight, rest);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << name;
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
            return true;
        }
        return false;
    };
    const double nan = std::nan("");
    const Vector3d none = Vector3d::Zero(), x(1, 0, 0);
    EXPECT_TRUE(refused(kinds::Plane{}, {0, 1}));
    EXPECT_TRUE(refused(kinds::EdgeStrain{}, {0, 1, 2}));
    EXPECT_TRUE(refused(kinds::Plane{}, {0, 1, 8}));
    EXPECT_TRUE(refused(kinds::Plane{}, {0, 1, -1}));
    EXPECT_TRUE(refused(kinds::Plane{}, {0, 1, 2}, -1));
    EXPECT_TRUE(refused(kinds::Plane{}, {0, 1, 2}, nan));
    for (const kinds::Interval& range :
         {kinds::Interval{2, 1}, {nan, 1}, {1, nan}, {-1, 1}, {kinds::infinity, kinds::infinity}}) {
        EXPECT_TRUE(refused(kinds::EdgeStrain{range}, {0, 1}));
        EXPECT_TRUE(refused(kinds::PolylineLength{range}, {0, 1}));
        EXPECT_TRUE(refused(kinds::Volume{range}, {0, 1, 2, 3}));
        EXPECT_TRUE(refused(kinds::Angle{range}, {0, 1, 2}));
    }
    EXPECT_TRUE(refused(kinds::Orientation{none}, {0, 1, 2}));
    EXPECT_TRUE(refused(kinds::CoAxiality{none, x}, {0, 1, 2}));
    EXPECT_TRUE(refused(kinds::CoAxiality{x, Vector3d(nan, 0, 0)}, {0, 1, 2}));
    EXPECT_TRUE(refused(kinds::OnSurface{}, {0}));
    EXPECT_TRUE(refused(kinds::Closeness{random_points(2, 3)}, {0}));
    EXPECT_TRUE(refused(kinds::EqualLengths{}, {0, 1, 2, 3, 4}));
    EXPECT_TRUE(refused(kinds::EqualLength{1}, {0, 1, 2, 3, 4}));
    EXPECT_TRUE(refused(kinds::Area{}, {0, 1, 1}));
    EXPECT_TRUE(refused(kinds::Volume{}, {0, 1, 2, 2}));
    EXPECT_FALSE(refused(kinds::Plane{}, {0, 1, 2}));

    kinds::AxisOnLine line{x, x, {0, 0, 1, 1}, {0, 1, 0, 0}};
    EXPECT_FALSE(refused(line, {0, 1, 2, 3}));
    for (const std::vector<double>& shares :
         {std::vector<double>{0, 1, 0}, {0, -0.1, 0, 0}, {0, 1.1, 0, 0}, {0, nan, 0, 0}, {1, 1, 0, 0}}) {
        line.shares = shares;
        EXPECT_TRUE(refused(line, {0, 1, 2, 3})) << testing::PrintToString(shares);
    }

    kinds::Proportion proportion{{1, 1}, {{0, 1}}};
    EXPECT_FALSE(refused(proportion, {0, 1}));
    proportion.part = 2;
    EXPECT_TRUE(refused(proportion, {0, 1, 2}));
    proportion.part = 0;
    proportion.measure.pins = {0, 2};
    EXPECT_TRUE(refused(proportion, {0, 1}));
    proportion.measure.pins = {0, 0};
    EXPECT_TRUE(refused(proportion, {0, 1}));
    proportion.measure.pins = {0, 1};
    proportion.second = kinds::PinnedMeasure{{0, 1}};
    EXPECT_FALSE(refused(proportion, {0, 1}));
    proportion.second->pins = {1, 1};
    EXPECT_TRUE(refused(proportion, {0, 1}));

    kinds::AxisDirection axis{x};
    EXPECT_FALSE(refused(axis, {0, 1, 2}));
    EXPECT_TRUE(refused(axis, {2, 2, 2}));
    EXPECT_TRUE(refused(axis, {2}));
    axis.rest_direction = none;
    EXPECT_TRUE(refused(axis, {0, 1, 2}));
    axis.rest_direction.reset();
    for (const kinds::Interval& range : {kinds::Interval{0, 1.6}, {0.2, 0.1}, {-0.1, 0.1}}) {
        axis.angle = range;
        EXPECT_TRUE(refused(axis, {0, 1, 2}));
    }
    EXPECT_TRUE(refused(kinds::AxisDirection{none}, {0, 1, 2}));

    kinds::MirrorInTriangles mirror{{x, x}, {0.5, 0.25, 0.25}};
    EXPECT_FALSE(refused(mirror, {0, 1, 2, 3}));
    EXPECT_TRUE(refused(mirror, {0, 1, 2}));
    EXPECT_TRUE(refused(mirror, {0, 1, 2, 3, 4, 5, 6, 7}));
    mirror.discrepancies = random_points(2, 3);
    EXPECT_TRUE(refused(mirror, {0, 1, 2, 3}));
    mirror.discrepancies.reset();
    mirror.barycentric = {0.5, 0.5, 0.25};
    EXPECT_TRUE(refused(mirror, {0, 1, 2, 3}));
    mirror.barycentric = {0.5, 0.5, nan};
    EXPECT_TRUE(refused(mirror, {0, 1, 2, 3}));
    mirror.barycentric = {0.5, 0.25, 0.25};
    mirror.plane.normal = none;
    EXPECT_TRUE(refused(mirror, {0, 1, 2, 3}));
    Points broken = rest;
    broken(1, 2) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(make_constraint(kinds::Plane{}, {0, 1, 2}, 1, broken), Error);
    EXPECT_THROW(make_constraint(kinds::Plane{}, {0, 1, 2}, 1, rest)->set_target(rest), Error);
}

}  // namespace
}  // namespace ostraka
