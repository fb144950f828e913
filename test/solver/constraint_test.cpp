// Laws that every kind of constraint obeys, and what is refused.
#include "outcome.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

TEST(Constraint, EveryKindHasAnExample) {
    const auto list = examples();
    for (const auto& kind : constraint_kinds())
        EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const Example& e) { return e.kind == kind.name; })) << kind.name;
}

TEST(Constraint, ProjectingTwiceIsProjectingOnce) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        const Outcome o = outcome(*c, e.points);
        EXPECT_LT((again(*c, o.projected) - o.projected).cwiseAbs().maxCoeff(), 1e-9) << e.name;
    }
}

TEST(Constraint, ExamplesBreakWhatTheyAskFor) {
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
        const Matrix3d own = e.rotates ? rotation : Matrix3d::Identity();
        const Example there = moved(e, own, by);
        const auto c = make(e), d = make(there);
        const Outcome o = outcome(*c, e.points), p = outcome(*d, there.points);
        const Eigen::VectorXd sums = matrix_of(*c).rowwise().sum();
        EXPECT_LT((own * o.projected + by * sums.transpose() - p.projected).cwiseAbs().maxCoeff(), 1e-8) << e.name;
        EXPECT_NEAR(c->residual(e.points), d->residual(there.points), 1e-8) << e.name;
    }
}

TEST(Constraint, ResidualIsTheSameFarFromTheOrigin) {
    for (const Example& e : examples()) {
        const Example there = moved(e, Matrix3d::Identity(), Vector3d(1e6, -1e6, 2e6));
        EXPECT_NEAR(make(e)->residual(e.points), make(there)->residual(there.points), 1e-7) << e.name;
    }
}

TEST(Constraint, RowsAreWhatTheMapSays) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        Points own(3, static_cast<Eigen::Index>(e.ids.size()));
        for (Eigen::Index i = 0; i < own.cols(); ++i) own.col(i) = e.points.col(e.ids[static_cast<std::size_t>(i)]);
        EXPECT_LT((outcome(*c, e.points).rows - own * matrix_of(*c).transpose()).cwiseAbs().maxCoeff(), 1e-12) << e.name;
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

TEST(Constraint, MomentsSayWhatTheProjectionSays) {
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

TEST(Constraint, RefusesWhatMakesNoSense) {
    const Points rest = random_points(8, 5);
    const auto refused = [&](const std::string& kind, const std::vector<int>& ids, const ConstraintParameters& p,
                             double weight = 1) {
        try {
            make_constraint(kind, ids, weight, p, rest);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << kind;
            EXPECT_NE(std::string(error.what()).find(kind), std::string::npos) << error.what();
            return true;
        }
        return false;
    };
    ConstraintParameters none, crossed, nan, no_length, few;
    crossed.min = 2;
    crossed.max = 1;
    nan.min = std::nan("");
    no_length.direction = Vector3d::Zero();
    few.target = random_points(2, 3);
    EXPECT_TRUE(refused("Planes", {0, 1, 2}, none));
    EXPECT_TRUE(refused("Plane", {0, 1}, none));
    EXPECT_TRUE(refused("EdgeStrain", {0, 1, 2}, none));
    EXPECT_TRUE(refused("Plane", {0, 1, 8}, none));
    EXPECT_TRUE(refused("Plane", {0, 1, -1}, none));
    EXPECT_TRUE(refused("Plane", {0, 1, 2}, none, -1));
    EXPECT_TRUE(refused("Plane", {0, 1, 2}, none, std::nan("")));
    for (const char* kind : {"EdgeStrain", "PolylineLength"}) {
        EXPECT_TRUE(refused(kind, {0, 1}, crossed));
        EXPECT_TRUE(refused(kind, {0, 1}, nan));
    }
    EXPECT_TRUE(refused("Volume", {0, 1, 2, 3}, crossed));
    EXPECT_TRUE(refused("Angle", {0, 1, 2}, crossed));
    EXPECT_TRUE(refused("Orientation", {0, 1, 2}, none));
    EXPECT_TRUE(refused("Orientation", {0, 1, 2}, no_length));
    EXPECT_TRUE(refused("CoAxiality", {0, 1, 2}, none));
    EXPECT_TRUE(refused("OnSurface", {0}, none));
    EXPECT_TRUE(refused("Closeness", {0}, few));
    EXPECT_TRUE(refused("Proportion", {0, 1, 2, 3}, none));
    EXPECT_TRUE(refused("EqualLengths", {0, 1, 2, 3, 4}, none));
    EXPECT_TRUE(refused("Area", {0, 1, 1}, none));
    EXPECT_TRUE(refused("Volume", {0, 1, 2, 2}, none));
    EXPECT_FALSE(refused("Plane", {0, 1, 2}, none));

    ConstraintParameters line;
    line.direction = line.point = Vector3d(1, 0, 0);
    line.stations = {0, 0, 1, 1};
    line.coefficients = {0, 1, 0, 0};
    EXPECT_FALSE(refused("AxisOnLine", {0, 1, 2, 3}, line));
    for (const std::vector<double>& shares :
         {std::vector<double>{0, 1, 0}, {0, -0.1, 0, 0}, {0, 1.1, 0, 0}, {0, std::nan(""), 0, 0}, {1, 1, 0, 0}}) {
        line.coefficients = shares;
        EXPECT_TRUE(refused("AxisOnLine", {0, 1, 2, 3}, line)) << testing::PrintToString(shares);
    }

    ConstraintParameters length;
    length.min = length.max = 1;
    length.absolute = true;
    length.pins = {0, 1};
    EXPECT_FALSE(refused("Proportion", {0, 1}, length));
    length.split = 2;
    EXPECT_TRUE(refused("Proportion", {0, 1, 2}, length));
    length.split = 0;
    length.pins = {0, 2};
    EXPECT_TRUE(refused("Proportion", {0, 1}, length));
    length.pins = {0, 0};
    EXPECT_TRUE(refused("Proportion", {0, 1}, length));
    length.pins = {0, 1, 0, 1};
    EXPECT_TRUE(refused("Proportion", {0, 1}, length));
    length.absolute = false;
    EXPECT_FALSE(refused("Proportion", {0, 1}, length));
    length.pins = {0, 1};
    EXPECT_TRUE(refused("Proportion", {0, 1}, length));

    ConstraintParameters axis;
    EXPECT_TRUE(refused("AxisDirection", {0, 1, 2}, axis));
    axis.direction = Vector3d(1, 0, 0);
    EXPECT_FALSE(refused("AxisDirection", {0, 1, 2}, axis));
    EXPECT_TRUE(refused("AxisDirection", {2, 2, 2}, axis));
    EXPECT_TRUE(refused("AxisDirection", {2}, axis));
    axis.rest_direction = Vector3d::Zero();
    EXPECT_TRUE(refused("AxisDirection", {0, 1, 2}, axis));
    axis.rest_direction.reset();
    axis.max = 1.6;
    EXPECT_TRUE(refused("AxisDirection", {0, 1, 2}, axis));
    axis.max = 0.1;
    axis.min = 0.2;
    EXPECT_TRUE(refused("AxisDirection", {0, 1, 2}, axis));
    axis.min = -0.1;
    EXPECT_TRUE(refused("AxisDirection", {0, 1, 2}, axis));

    ConstraintParameters mirror;
    mirror.direction = mirror.point = Vector3d(1, 0, 0);
    mirror.coefficients = {0.5, 0.25, 0.25};
    EXPECT_FALSE(refused("MirrorSymmetry", {0, 1, 2, 3}, mirror));
    EXPECT_TRUE(refused("MirrorSymmetry", {0, 1, 2}, mirror));
    EXPECT_TRUE(refused("MirrorSymmetry", {0, 1, 2, 3, 4, 5, 6, 7}, mirror));
    mirror.target = random_points(2, 3);
    EXPECT_TRUE(refused("MirrorSymmetry", {0, 1, 2, 3}, mirror));
    mirror.target.reset();
    mirror.coefficients = {0.5, 0.5, 0.25};
    EXPECT_TRUE(refused("MirrorSymmetry", {0, 1, 2, 3}, mirror));
    mirror.coefficients = {0.5, 0.5, std::nan("")};
    EXPECT_TRUE(refused("MirrorSymmetry", {0, 1, 2, 3}, mirror));
    mirror.coefficients = {0.5, 0.25, 0.25};
    mirror.direction.reset();
    EXPECT_TRUE(refused("MirrorSymmetry", {0, 1, 2, 3}, mirror));
    Points broken = rest;
    broken(1, 2) = std::numeric_limits<double>::infinity();
    EXPECT_THROW(make_constraint("Plane", {0, 1, 2}, 1, {}, broken), Error);
    EXPECT_THROW(make_constraint("Plane", {0, 1, 2}, 1, {}, rest)->set_target(rest), Error);
}

}  // namespace
}  // namespace ostraka
