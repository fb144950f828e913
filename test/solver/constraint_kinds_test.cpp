// What each kind of constraint admits.
#include "outcome.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

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
        } else if (e.kind == "MeanPosition") {
            EXPECT_EQ(m.rows.cols(), 1);
            EXPECT_LT((m.rows.col(0) - *e.parameters.point).norm(), 1e-12);
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
        EXPECT_EQ(c->constant(), displacement || e.kind == "Closeness" || e.kind == "MeanPosition" || e.kind == "Laplacian" ||
                                     e.kind == "CotangentLaplacian");
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
    const Points points = some_rotation() * rest;
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

}  // namespace
}  // namespace ostraka
