// Laws that every kind of constraint obeys, and what each admits.
#include "examples.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Outcome {
    Points rows, projected;
};

Outcome outcome(const Constraint& c, const Points& points) {
    Outcome o;
    c.rows_of(points, o.rows);
    o.projected.resize(3, o.rows.cols());
    c.project(o.rows, o.projected);
    return o;
}

Points again(const Constraint& c, const Points& rows) {
    Points projected(3, rows.cols());
    c.project(rows, projected);
    return projected;
}

double squared_distance(const Constraint& c, const Points& a, const Points& b) {
    return (a - b).leftCols(c.map().rows - c.map().observed).squaredNorm();
}

/// B over the constraint's own ids, dense.
Eigen::MatrixXd matrix_of(const Constraint& c) {
    const auto& map = c.map();
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(map.rows, static_cast<Eigen::Index>(c.ids().size()));
    for (Eigen::Index i = 0; i < map.direct; ++i) {
        b(i, i) += 1;
        if (map.centred) b.row(i).head(map.direct).array() -= 1.0 / static_cast<double>(map.direct);
    }
    for (const auto& e : map.entries) b(map.direct + e.row, e.position) += e.value;
    return b;
}

Matrix3d some_turn() { return Eigen::AngleAxisd(1.1, Vector3d(1, 2, -2).normalized()).toRotationMatrix(); }

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
    const Matrix3d turn = some_turn();
    const Vector3d by(3, -2, 5);
    for (const Example& e : examples()) {
        const Matrix3d own = e.turns ? turn : Matrix3d::Identity();
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

// What is admitted, measured on points that have the projected rows.

struct Measured {
    Points rows, x;  ///< x: points whose rows are the projected ones, up to translation
};

Measured projected_points(const Example& e) {
    const auto c = make(e);
    const Outcome o = outcome(*c, e.points);
    const Eigen::MatrixXd b = matrix_of(*c);
    return {o.projected, (b.completeOrthogonalDecomposition().solve(o.projected.transpose())).transpose()};
}

double singular_value(const Points& rows, int which) { return Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues()[which]; }

double area(const Points& p) { return (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm() / 2; }
double volume(const Points& p) { return (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).dot(p.col(3) - p.col(0)) / 6; }
double angle(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Angle between a direction and the axis that the best rotation from rest carries along.
double angle_of_axis(const Example& e, const Points& now) {
    const Points shape = e.rest.colwise() - e.rest.rowwise().mean();
    Vector3d axis = Eigen::JacobiSVD<Eigen::MatrixXd>(shape, Eigen::ComputeFullU).matrixU().col(0);
    if (e.parameters.rest_direction) axis = *e.parameters.rest_direction;
    const Matrix3d carried = Eigen::umeyama(shape, now, false).topLeftCorner<3, 3>();
    const double found = angle(carried * axis, *e.parameters.direction);
    return std::min(found, std::numbers::pi - found);
}

TEST(Constraint, AdmitsWhatItsNameSays) {
    int checked = 0;
    for (const Example& e : examples()) {
        const Measured m = projected_points(e);
        const Points& x = m.x;
        const double low = e.parameters.min.value_or(1) - 1e-9, high = e.parameters.max.value_or(1) + 1e-9;
        const auto within = [&](double value, double rest) {
            const double share = e.parameters.absolute ? value : value / rest;
            EXPECT_GE(share, low) << e.name;
            EXPECT_LE(share, high) << e.name;
        };
        const auto length = [](const Points& p, Eigen::Index a, Eigen::Index b) { return (p.col(b) - p.col(a)).norm(); };
        ++checked;
        if (e.kind == "EdgeStrain") {
            within(length(x, 0, 1), length(e.rest, 0, 1));
        } else if (e.kind == "Area") {
            within(area(x), area(e.rest));
        } else if (e.kind == "Volume") {
            within(e.parameters.absolute ? std::abs(volume(x)) : volume(x), volume(e.rest));
        } else if (e.kind == "TriangleStrain" || e.kind == "TetrahedronStrain") {
            const Eigen::Index n = x.cols() - 1;
            const Eigen::MatrixXd rest = e.rest.rightCols(n).colwise() - e.rest.col(0), now = x.rightCols(n).colwise() - x.col(0);
            const Eigen::MatrixXd f = now * rest.completeOrthogonalDecomposition().pseudoInverse();
            const auto s = Eigen::JacobiSVD<Eigen::MatrixXd>(f).singularValues();
            for (Eigen::Index i = 0; i < n; ++i) within(s[i], 1);
            if (n == 3) {
                EXPECT_GT(f.determinant(), 0) << e.name;
            }
        } else if (e.kind == "Line") {
            EXPECT_LT(singular_value(m.rows, 1), 1e-12) << e.name;
        } else if (e.kind == "Plane") {
            EXPECT_LT(singular_value(m.rows, 2), 1e-12) << e.name;
        } else if (e.kind == "Orientation") {
            EXPECT_LT((e.parameters.direction->transpose() * m.rows).norm(), 1e-12) << e.name;
        } else if (e.kind == "FittedPlaneOrientation") {
            const Eigen::JacobiSVD<Eigen::MatrixXd> svd(m.rows, Eigen::ComputeFullU);
            EXPECT_NEAR(std::abs(svd.matrixU().col(2).dot(e.parameters.direction->normalized())), 1, 1e-12) << e.name;
        } else if (e.kind == "Circle" || e.kind == "Sphere") {
            // |x|^2 - 2 c x = const has an exact solution, and the circle is flat.
            Eigen::MatrixXd a(x.cols(), 4);
            a << 2 * m.rows.transpose(), Eigen::VectorXd::Ones(x.cols());
            const Eigen::VectorXd right = m.rows.colwise().squaredNorm();
            EXPECT_LT((a * a.completeOrthogonalDecomposition().solve(right) - right).norm(), 1e-10) << e.name;
            if (e.kind == "Circle") {
                EXPECT_LT(singular_value(m.rows, 2), 1e-10) << e.name;
            }
        } else if (e.kind == "Rigid" || e.kind == "Similarity") {
            const Points& shape = e.parameters.target ? *e.parameters.target : e.rest;
            const double scale = length(x, 0, 1) / length(shape, 0, 1);
            for (Eigen::Index i = 0; i < x.cols(); ++i)
                for (Eigen::Index j = 0; j < i; ++j) EXPECT_NEAR(length(x, i, j), scale * length(shape, i, j), 1e-10) << e.name;
            if (e.kind == "Rigid" || e.parameters.min) within(scale, 1);
            { EXPECT_GT(volume(x) * volume(shape), 0) << e.name; }
        } else if (e.kind == "NonUniformScaling") {
            const Vector3d axis = e.parameters.direction->normalized();
            const Matrix3d f = (x.colwise() - x.col(0)).matrix() *
                               (e.rest.colwise() - e.rest.col(0)).matrix().completeOrthogonalDecomposition().pseudoInverse();
            const Matrix3d stretch = f.transpose() * f;  // I + (s^2 - 1) a a^T
            const double s = std::sqrt(axis.dot(stretch * axis));
            EXPECT_LT((stretch - Matrix3d::Identity() - (s * s - 1) * axis * axis.transpose()).norm(), 1e-10) << e.name;
            if (e.parameters.min) within(s, 1);
        } else if (e.kind == "Equilateral") {
            for (Eigen::Index i = 0; i < x.cols(); ++i) {
                EXPECT_NEAR(length(x, i, (i + 1) % x.cols()), length(x, 0, 1), 1e-10) << e.name;
                EXPECT_NEAR(length(x, i, (i + 2) % x.cols()), length(x, 0, 2), 1e-10) << e.name;
            }
            EXPECT_GT(length(x, 0, 1), 0.1);
        } else if (e.kind == "Parallelogram" || e.kind == "Rectangle") {
            EXPECT_LT((x.col(0) - x.col(1) + x.col(2) - x.col(3)).norm(), 1e-12) << e.name;
            if (e.kind == "Rectangle") {
                EXPECT_NEAR((x.col(1) - x.col(0)).dot(x.col(3) - x.col(0)), 0, 1e-12);
            }
        } else if (e.kind == "CoAxiality") {
            for (Eigen::Index i = 0; i < x.cols(); ++i)
                for (Eigen::Index j = 0; j < i; ++j) EXPECT_NEAR(length(m.rows, i, j), length(e.points, i, j), 1e-10) << e.name;
        } else if (e.kind == "AxisDirection") {
            for (Eigen::Index i = 0; i < x.cols(); ++i)
                for (Eigen::Index j = 0; j < i; ++j) EXPECT_NEAR(length(m.rows, i, j), length(e.points, i, j), 1e-10) << e.name;
            EXPECT_NEAR(angle_of_axis(e, m.rows),
                        std::clamp(angle_of_axis(e, e.points), e.parameters.min.value_or(0), e.parameters.max.value_or(0)), 1e-10)
                << e.name;
        } else if (e.kind == "MirrorSymmetry" && e.parameters.direction) {
            const Vector3d n = e.parameters.direction->normalized();
            for (Eigen::Index i = 0; i < m.rows.cols(); i += 2) {
                const Vector3d p = m.rows.col(i) - *e.parameters.point;
                Vector3d off = p - 2 * n.dot(p) * n + *e.parameters.point - m.rows.col(i + 1);
                if (e.parameters.target) off -= e.parameters.target->col(i / 2);
                EXPECT_LT(off.norm(), 1e-12) << e.name;
            }
        } else if (e.kind == "AxisOnLine") {
            for (Eigen::Index i = 0; i < m.rows.cols(); ++i)
                EXPECT_LT((m.rows.col(i) - *e.parameters.point).cross(e.parameters.direction->normalized()).norm(), 1e-12);
        } else if (e.kind == "MeansOnLevel") {
            for (Eigen::Index i = 1; i < m.rows.cols(); ++i)
                EXPECT_NEAR((m.rows.col(i) - m.rows.col(0)).dot(*e.parameters.direction), 0, 1e-12);
        } else if (e.kind == "Proportion") {
            const Vector3d first = m.rows.col(1) - m.rows.col(0);
            const Vector3d second = e.parameters.absolute ? Vector3d::UnitX() : Vector3d(m.rows.rightCols<1>());
            const double l1 = e.parameters.direction ? std::abs(first.dot(e.parameters.direction->normalized())) : first.norm();
            const double l2 =
                e.parameters.second_direction ? std::abs(second.dot(e.parameters.second_direction->normalized())) : second.norm();
            within(l1 / l2, 1);
        } else if (e.kind == "Angle") {
            within(angle(m.rows.col(0), m.rows.col(1)), 1);
        } else if (e.kind == "Perpendicular") {
            EXPECT_NEAR(m.rows.col(0).dot(m.rows.col(1)), 0, 1e-12);
        } else if (e.kind == "Parallel") {
            EXPECT_LT(singular_value(m.rows, 1), 1e-12);
        } else if (e.kind == "PolylineLength") {
            double rest = 0;
            for (Eigen::Index i = 0; i + 1 < e.rest.cols(); ++i) rest += length(e.rest, i, i + 1);
            within(m.rows.colwise().norm().sum(), rest);
        } else if (e.kind == "EqualLengths") {
            for (Eigen::Index i = 0; i < m.rows.cols(); ++i) EXPECT_NEAR(m.rows.col(i).norm(), m.rows.col(0).norm(), 1e-12);
        } else if (e.kind == "EqualLength") {
            const Eigen::Index first = e.parameters.split - 1;
            EXPECT_NEAR(m.rows.leftCols(first).colwise().norm().sum(),
                        m.rows.rightCols(m.rows.cols() - first).colwise().norm().sum(), 1e-12);
        } else if (e.kind == "OnSurface") {
            for (Eigen::Index i = 0; i < m.rows.cols(); ++i)
                EXPECT_NEAR((m.rows.col(i) - Vector3d(0.1, 0.2, 0.3)).norm(), 0.7, 1e-12);
        } else if (e.kind == "Bending") {
            within(m.rows.norm(), outcome(*make(e), e.rest).rows.norm());
        } else {
            --checked;
        }
    }
    EXPECT_GT(checked, 40);
}

TEST(Constraint, ConstantsAreWhatTheyWereAtRest) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        const bool displacement = e.kind.find("Displacement") != std::string::npos;
        if (displacement || (e.kind == "Closeness" && !e.parameters.target)) {
            EXPECT_LT(c->residual(e.rest), 1e-14) << e.name;
        }
        if (displacement) {
            EXPECT_GT(outcome(*c, e.points).projected.norm(), 0.01) << e.name;
        }
        if (e.kind == "Laplacian" || e.kind == "CotangentLaplacian") {
            EXPECT_EQ(outcome(*c, e.points).projected.norm(), 0) << e.name;
        }
        EXPECT_EQ(c->constant(),
                  displacement || e.kind == "Closeness" || e.kind == "Laplacian" || e.kind == "CotangentLaplacian");
    }
}

TEST(Constraint, AnglesThatAreTooFarOffCollapseTheShorterSide) {
    Points points(3, 3);
    points.col(0) << 0, 0, 0;
    points.col(1) << 2, 0, 0;
    points.col(2) << 1, 0.1, 0;
    ConstraintParameters parameters;
    parameters.min = parameters.max = 3;
    const Outcome o = outcome(*make_constraint("Angle", {0, 1, 2}, 1, parameters, points), points);
    EXPECT_EQ(o.projected.col(0), o.rows.col(0));
    EXPECT_EQ(o.projected.col(1).norm(), 0);
}

TEST(Constraint, FlatBendIsNone) {
    Points rest(3, 4);
    rest.col(0) << 0, 0, 0;
    rest.col(1) << 1, 0.2, 0;
    rest.col(2) << 0.4, 1, 0;
    rest.col(3) << 0.3, -0.7, 0;
    const auto c = make_constraint("Bending", {0, 1, 2, 3}, 1, {}, rest);
    EXPECT_LT(c->residual(rest), 1e-15);
    Points bent = rest;
    bent(2, 3) = 0.2;
    EXPECT_GT(c->residual(bent), 0.05);
}

TEST(Constraint, CotangentLaplacianOfAFlatRingIsZero) {
    Points rest(3, 6);
    rest.col(0) << 0.1, 0.05, 0;
    for (int i = 0; i < 5; ++i) rest.col(i + 1) << std::cos(1.2566 * i), (1 + 0.1 * i) * std::sin(1.2566 * i), 0;
    EXPECT_LT(make_constraint("CotangentLaplacian", first_ids(6), 1, {}, rest)->residual(rest), 1e-12);
    EXPECT_GT(make_constraint("Laplacian", first_ids(6), 1, {}, rest)->residual(rest), 1e-2);
}

TEST(Constraint, SolidsOfRevolutionHaveTheAxisThatIsCarried) {
    // A tilted cylinder: its axis is brought onto the line, whatever spin is left, and its shape is untouched.
    Points rest(3, 40);
    for (int i = 0; i < 40; ++i) rest.col(i) << std::cos(i), std::sin(i), 0.25 * i;
    ConstraintParameters parameters;
    parameters.direction = Vector3d(0, 1, 0.2);
    parameters.point = Vector3d(4, 5, 6);
    parameters.rest_direction = Vector3d(0, 0, 1);
    parameters.rest_point = Vector3d(0, 0, 0);
    const auto c = make_constraint("CoAxiality", first_ids(40), 1, parameters, rest);
    const Points points = some_turn() * rest;
    const Points p = outcome(*c, points).projected;
    const Vector3d d = parameters.direction->normalized();
    for (int i = 0; i < 40; ++i) EXPECT_NEAR((p.col(i) - *parameters.point).cross(d).norm(), 1, 1e-10);
}

TEST(Constraint, StationsShareTheirPoints) {
    const Points rest = random_points(4, 9);
    ConstraintParameters parameters;
    parameters.direction = Vector3d(0, 0, 1);
    parameters.point = Vector3d(1, 2, 3);
    parameters.stations = {0, 0, 1, 1};
    parameters.coefficients = {0, 0.25, 0, 0};
    const auto c = make_constraint("AxisOnLine", first_ids(4), 1, parameters, rest);
    const Outcome o = outcome(*c, rest);
    EXPECT_LT((o.rows.col(0) - (rest.col(0) + 0.75 * rest.col(1)) / 1.75).norm(), 1e-15);
    EXPECT_LT((o.rows.col(1) - (0.25 * rest.col(1) + rest.col(2) + rest.col(3)) / 2.25).norm(), 1e-15);
    for (Eigen::Index s = 0; s < 2; ++s) EXPECT_LT((o.projected.col(s) - Vector3d(1, 2, o.rows(2, s))).norm(), 1e-15);
    // Without shares, as each for itself.
    parameters.coefficients.assign(4, 0.0);
    const Outcome none = outcome(*make_constraint("AxisOnLine", first_ids(4), 1, parameters, rest), rest);
    parameters.coefficients.clear();
    EXPECT_EQ(none.rows, outcome(*make_constraint("AxisOnLine", first_ids(4), 1, parameters, rest), rest).rows);
    // A station may live on shares alone, the last one too.
    parameters.coefficients = {0, 0, 0.5, 0};
    const Outcome last = outcome(*make_constraint("AxisOnLine", first_ids(4), 1, parameters, rest), rest);
    ASSERT_EQ(last.rows.cols(), 3);
    EXPECT_EQ(last.rows.col(2), rest.col(2));
    parameters.stations = {0, 0, 2, 2};
    parameters.coefficients = {1, 0, 0, 0};
    EXPECT_EQ(outcome(*make_constraint("AxisOnLine", first_ids(4), 1, parameters, rest), rest).rows.col(1), rest.col(0));
}

TEST(Constraint, OneMeasureIsStretchedFromItsAnchors) {
    // A rod from 0 to 4 that stands on its first point, to be 5 to 6 long; its measure is the height.
    Points rest(3, 5), points(3, 5);
    for (int i = 0; i < 5; ++i) rest.col(i) << 0.1 * i * i, 0, i;
    ConstraintParameters parameters;
    parameters.absolute = true;
    parameters.min = 5;
    parameters.max = 6;
    parameters.pins = {0, 4};
    parameters.anchors = {0};
    parameters.direction = Vector3d(0, 0, 2);
    const auto c = make_constraint("Proportion", first_ids(5), 1, parameters, rest);
    EXPECT_EQ(c->map().observed, 0);
    for (const double height : {2.0, 5.5, 9.0}) {
        points = rest;
        points.row(2) *= height / 4;
        Points expected = rest;
        expected.row(2) *= std::clamp(height, 5.0, 6.0) / 4;
        EXPECT_LT((outcome(*c, points).projected - expected).norm(), 1e-14) << height;
    }
    parameters.anchors.clear();  // about the mean
    points = rest;
    const Points p = outcome(*make_constraint("Proportion", first_ids(5), 1, parameters, rest), points).projected;
    EXPECT_NEAR(p(2, 4), 2.5, 1e-14);
    EXPECT_NEAR(p(2, 0), -2.5, 1e-14);
}

/// The least squared distance of turned rows with the axis at an angle to a direction, by trying all turns.
double least_by_trying(const Points& rows, const Vector3d& axis, const Vector3d& direction, double wanted) {
    double least = std::numeric_limits<double>::infinity();
    constexpr int steps = 120;
    const Vector3d e1 = direction.unitOrthogonal();
    const auto turn = [](int i, const Vector3d& about) {
        return Eigen::AngleAxisd(2 * std::numbers::pi * i / steps, about).toRotationMatrix();
    };
    for (const double side : {1.0, -1.0})
        for (int i = 0; i < steps; ++i) {
            const Vector3d to = std::cos(wanted) * side * direction + std::sin(wanted) * (turn(i, direction) * e1);
            const Matrix3d first = Eigen::Quaterniond::FromTwoVectors(axis, to).toRotationMatrix();
            for (int j = 0; j < steps; ++j) least = std::min(least, (turn(j, to) * first * rows - rows).squaredNorm());
        }
    return least;
}

TEST(Constraint, AxesTurnNoFartherThanTheyMust) {
    // Rods, plates and blocks whose axis is known, turned anyhow and exactly along and across the direction.
    const Vector3d d = Vector3d(1, -2, 3).normalized();
    for (const Vector3d& size :
         {Vector3d(1, 1, 4), Vector3d(1, 2, 4), Vector3d(1, 0, 3), Vector3d(3, 3, 0.5), Vector3d(2, 2, 2)}) {
        Points rest = random_points(30, 6);
        rest.colwise() -= rest.rowwise().mean().eval();
        rest = size.asDiagonal() * rest;
        for (const Vector3d& own : {Vector3d(0, 0, 1), Vector3d(0.6, 0, 0.8)})
            for (int place = 0; place < 4; ++place) {
                Matrix3d turn = some_turn();
                if (place == 1) turn = Eigen::Quaterniond::FromTwoVectors(own, d).toRotationMatrix();
                if (place == 2) turn = Eigen::Quaterniond::FromTwoVectors(own, d.unitOrthogonal()).toRotationMatrix();
                if (place == 3) turn = Eigen::Quaterniond::FromTwoVectors(own, -d + 1e-7 * d.unitOrthogonal()).toRotationMatrix();
                const Points rows = turn * rest;
                for (const double wanted : {0.0, 1e-4, 0.3, 1.2, std::numbers::pi / 2}) {
                    ConstraintParameters parameters;
                    parameters.direction = d;
                    parameters.rest_direction = own;
                    parameters.min = parameters.max = wanted;
                    const auto c = make_constraint("AxisDirection", first_ids(30), 1, parameters, rest);
                    const Outcome o = outcome(*c, rows);
                    const std::string what = testing::PrintToString(size.transpose().eval()) + " place " + std::to_string(place) +
                                             " angle " + std::to_string(wanted);
                    const Matrix3d found = Eigen::umeyama(rows, o.projected, false).topLeftCorner<3, 3>();
                    ASSERT_LT((found * rows - o.projected).norm(), 1e-10) << what;
                    const double angle_there = angle(found * turn * own, d);
                    ASSERT_NEAR(std::min(angle_there, std::numbers::pi - angle_there), wanted, 2e-8) << what;
                    const double least = least_by_trying(rows, turn * own, d, wanted),
                                 reached = (o.rows - o.projected).squaredNorm();
                    ASSERT_LE(reached, least + 1e-9 * rows.squaredNorm()) << what;
                    ASSERT_LT((again(*c, o.projected) - o.projected).norm(), 1e-7) << what;
                }
            }
    }
}

TEST(Constraint, AxesThatAreInRangeStay) {
    const Points rest = random_points(9, 12);
    ConstraintParameters parameters;
    parameters.direction = Vector3d(0, 0, 1);
    parameters.rest_direction = Vector3d(1, 0, 1);  // at pi / 4
    parameters.min = 0.7;
    parameters.max = 0.8;
    EXPECT_EQ(make_constraint("AxisDirection", first_ids(9), 1, parameters, rest)->residual(rest), 0);
    parameters.min.reset();
    EXPECT_EQ(make_constraint("AxisDirection", first_ids(9), 1, parameters, rest)->residual(rest), 0);
    parameters.min = 0.7;
    parameters.max.reset();  // up to a right angle
    EXPECT_EQ(make_constraint("AxisDirection", first_ids(9), 1, parameters, rest)->residual(rest), 0);
    parameters.min.reset();  // parallel
    EXPECT_GT(make_constraint("AxisDirection", first_ids(9), 1, parameters, rest)->residual(rest), 0.1);
}

TEST(Constraint, PartnersInTrianglesMirror) {
    // A point and a triangle on the other side of x = 1, whose mirror image of the point is at (3, 0.25, 0.25) but for a bump.
    Points rest(3, 4);
    rest.col(0) << -1, 0.25, 0.25;
    rest.col(1) << 3, 0, 0;
    rest.col(2) << 3, 1, 0;
    rest.col(3) << 3, 0, 1;
    ConstraintParameters parameters;
    parameters.direction = Vector3d(2, 0, 0);
    parameters.point = Vector3d(1, 7, 7);
    parameters.coefficients = {0.5, 0.25, 0.25};
    const auto exact = make_constraint("MirrorSymmetry", first_ids(4), 1, parameters, rest);
    EXPECT_LT(exact->residual(rest), 1e-15);
    Points bumped = rest;
    bumped.col(0) += Vector3d(-0.4, 0.2, 0.6);
    // Each side takes half of it.
    const Outcome o = outcome(*exact, bumped);
    EXPECT_LT((o.projected.col(0) - Vector3d(-1.2, 0.35, 0.55)).norm(), 1e-15);
    EXPECT_LT((o.projected.col(1) - Vector3d(3.2, 0.35, 0.55)).norm(), 1e-15);
    // What is off at rest stays so.
    const Points off = Vector3d(0.4, 0.2, 0.6);
    parameters.target = off;
    const auto nearly = make_constraint("MirrorSymmetry", first_ids(4), 1, parameters, bumped);
    EXPECT_LT(nearly->residual(bumped), 1e-15);
    EXPECT_NEAR(nearly->residual(rest), off.norm(), 1e-15);
    exact->set_target(off);
    EXPECT_LT(exact->residual(bumped), 1e-15);
    EXPECT_THROW(exact->set_target(bumped), Error);
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
