// Admissible sets of each kind of constraint.
#include "outcome.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

// Measures of points that have the projected rows.

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

/// Angle between a direction and the axis transformed by the best rotation from rest.
double angle_of_axis(const Example& e, const kinds::AxisDirection& kind, const Points& now) {
    const Points shape = e.rest.colwise() - e.rest.rowwise().mean();
    Vector3d axis = Eigen::JacobiSVD<Eigen::MatrixXd>(shape, Eigen::ComputeFullU).matrixU().col(0);
    if (kind.rest_direction) axis = *kind.rest_direction;
    const Matrix3d carried = Eigen::umeyama(shape, now, false).topLeftCorner<3, 3>();
    const double deviation = angle(carried * axis, kind.direction);
    return std::min(deviation, std::numbers::pi - deviation);
}

double length(const Points& p, Eigen::Index a, Eigen::Index b) { return (p.col(b) - p.col(a)).norm(); }

/// Checks the projection of an example by its kind; returns false for kinds that other tests check.
struct Admits {
    const Example& e;
    const Measured m = projected_points(e);
    const Points& x = m.x;

    void within(const kinds::Interval& range, double value) const {
        EXPECT_GE(value, range.min - 1e-9) << e.name;
        EXPECT_LE(value, range.max + 1e-9) << e.name;
    }
    /// A range relative to the value at rest, or absolute.
    void within(const kinds::Interval& range, bool absolute, double value, double rest) const {
        within(range, absolute ? value : value / rest);
    }
    void strain_within(const kinds::Interval& range) const {
        const Eigen::Index n = x.cols() - 1;
        const Eigen::MatrixXd rest = e.rest.rightCols(n).colwise() - e.rest.col(0), now = x.rightCols(n).colwise() - x.col(0);
        const Eigen::MatrixXd f = now * rest.completeOrthogonalDecomposition().pseudoInverse();
        const auto s = Eigen::JacobiSVD<Eigen::MatrixXd>(f).singularValues();
        for (Eigen::Index i = 0; i < n; ++i) within(range, s[i]);
        if (n == 3) {
            EXPECT_GT(f.determinant(), 0) << e.name;
        }
    }
    /// |x|^2 - 2 c x = const has an exact solution.
    void is_round() const {
        Eigen::MatrixXd a(x.cols(), 4);
        a << 2 * m.rows.transpose(), Eigen::VectorXd::Ones(x.cols());
        const Eigen::VectorXd right = m.rows.colwise().squaredNorm();
        EXPECT_LT((a * a.completeOrthogonalDecomposition().solve(right) - right).norm(), 1e-10) << e.name;
    }
    /// The scale of a copy of a shape.
    double scale_of(const std::optional<Points>& given) const {
        const Points& shape = given ? *given : e.rest;
        const double scale = length(x, 0, 1) / length(shape, 0, 1);
        for (Eigen::Index i = 0; i < x.cols(); ++i)
            for (Eigen::Index j = 0; j < i; ++j) EXPECT_NEAR(length(x, i, j), scale * length(shape, i, j), 1e-10) << e.name;
        { EXPECT_GT(volume(x) * volume(shape), 0) << e.name; }
        return scale;
    }
    void is_moved_rigidly() const {
        for (Eigen::Index i = 0; i < x.cols(); ++i)
            for (Eigen::Index j = 0; j < i; ++j) EXPECT_NEAR(length(m.rows, i, j), length(e.points, i, j), 1e-10) << e.name;
    }
    void is_mirrored(const kinds::MirrorPlane& plane, const std::optional<Points>& discrepancies = {}) const {
        const Vector3d n = plane.normal.normalized();
        for (Eigen::Index i = 0; i < m.rows.cols(); i += 2) {
            const Vector3d p = m.rows.col(i) - plane.point;
            Vector3d off = p - 2 * n.dot(p) * n + plane.point - m.rows.col(i + 1);
            if (discrepancies) off -= discrepancies->col(i / 2);
            EXPECT_LT(off.norm(), 1e-12) << e.name;
        }
    }

    template <class Kind>
    bool operator()(const Kind&) const {
        return false;
    }
    bool operator()(const kinds::EdgeStrain& k) const {
        within(k.length, k.absolute, length(x, 0, 1), length(e.rest, 0, 1));
        return true;
    }
    bool operator()(const kinds::Area& k) const {
        within(k.area, k.absolute, area(x), area(e.rest));
        return true;
    }
    bool operator()(const kinds::Volume& k) const {
        within(k.volume, k.absolute, k.absolute ? std::abs(volume(x)) : volume(x), volume(e.rest));
        return true;
    }
    bool operator()(const kinds::TriangleStrain& k) const {
        strain_within(k.stretch);
        return true;
    }
    bool operator()(const kinds::TetrahedronStrain& k) const {
        strain_within(k.stretch);
        return true;
    }
    bool operator()(const kinds::Line&) const {
        EXPECT_LT(singular_value(m.rows, 1), 1e-12) << e.name;
        return true;
    }
    bool operator()(const kinds::Plane&) const {
        EXPECT_LT(singular_value(m.rows, 2), 1e-12) << e.name;
        return true;
    }
    bool operator()(const kinds::Orientation& k) const {
        EXPECT_LT((k.normal.transpose() * m.rows).norm(), 1e-12) << e.name;
        return true;
    }
    bool operator()(const kinds::FittedPlaneOrientation& k) const {
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(m.rows, Eigen::ComputeFullU);
        EXPECT_NEAR(std::abs(svd.matrixU().col(2).dot(k.normal.normalized())), 1, 1e-12) << e.name;
        return true;
    }
    bool operator()(const kinds::Circle&) const {
        is_round();
        EXPECT_LT(singular_value(m.rows, 2), 1e-10) << e.name;
        return true;
    }
    bool operator()(const kinds::Sphere&) const {
        is_round();
        return true;
    }
    bool operator()(const kinds::Rigid& k) const {
        EXPECT_NEAR(scale_of(k.shape), 1, 1e-9) << e.name;
        return true;
    }
    bool operator()(const kinds::Similarity& k) const {
        within(k.scale, scale_of(k.shape));
        return true;
    }
    bool operator()(const kinds::NonUniformScaling& k) const {
        const Vector3d axis = k.axis.normalized();
        const Matrix3d f = (x.colwise() - x.col(0)).matrix() *
                           (e.rest.colwise() - e.rest.col(0)).matrix().completeOrthogonalDecomposition().pseudoInverse();
        const Matrix3d stretch = f.transpose() * f;  // I + (s^2 - 1) a a^T
        const double s = std::sqrt(axis.dot(stretch * axis));
        EXPECT_LT((stretch - Matrix3d::Identity() - (s * s - 1) * axis * axis.transpose()).norm(), 1e-10) << e.name;
        within(k.scale, s);
        return true;
    }
    bool operator()(const kinds::Equilateral&) const {
        for (Eigen::Index i = 0; i < x.cols(); ++i) {
            EXPECT_NEAR(length(x, i, (i + 1) % x.cols()), length(x, 0, 1), 1e-10) << e.name;
            EXPECT_NEAR(length(x, i, (i + 2) % x.cols()), length(x, 0, 2), 1e-10) << e.name;
        }
        EXPECT_GT(length(x, 0, 1), 0.1);
        return true;
    }
    bool operator()(const kinds::Parallelogram&) const {
        EXPECT_LT((x.col(0) - x.col(1) + x.col(2) - x.col(3)).norm(), 1e-12) << e.name;
        return true;
    }
    bool operator()(const kinds::Rectangle&) const {
        EXPECT_NEAR((x.col(1) - x.col(0)).dot(x.col(3) - x.col(0)), 0, 1e-12);
        return (*this)(kinds::Parallelogram{});
    }
    bool operator()(const kinds::CoAxiality&) const {
        is_moved_rigidly();
        return true;
    }
    bool operator()(const kinds::AxisDirection& k) const {
        is_moved_rigidly();
        EXPECT_NEAR(angle_of_axis(e, k, m.rows), k.angle.clamp(angle_of_axis(e, k, e.points)), 1e-10) << e.name;
        return true;
    }
    bool operator()(const kinds::MirrorSymmetry& k) const {
        if (k.plane) is_mirrored(*k.plane);
        return k.plane.has_value();
    }
    bool operator()(const kinds::MirrorInTriangles& k) const {
        is_mirrored(k.plane, k.discrepancies);
        return true;
    }
    bool operator()(const kinds::AxisOnLine& k) const {
        for (Eigen::Index i = 0; i < m.rows.cols(); ++i)
            EXPECT_LT((m.rows.col(i) - k.point).cross(k.direction.normalized()).norm(), 1e-12);
        return true;
    }
    bool operator()(const kinds::MeansOnLevel& k) const {
        for (Eigen::Index i = 1; i < m.rows.cols(); ++i) EXPECT_NEAR((m.rows.col(i) - m.rows.col(0)).dot(k.up), 0, 1e-12);
        return true;
    }
    bool operator()(const kinds::MeanPosition& k) const {
        EXPECT_EQ(m.rows.cols(), 1);
        EXPECT_LT((m.rows.col(0) - k.place).norm(), 1e-12);
        return true;
    }
    bool operator()(const kinds::Proportion& k) const {
        const auto size = [](const Vector3d& edge, const std::optional<Vector3d>& along) {
            return along ? std::abs(edge.dot(along->normalized())) : edge.norm();
        };
        const double first = size(m.rows.col(1) - m.rows.col(0), k.measure.direction);
        within(k.range, first / (k.second ? size(m.rows.rightCols<1>(), k.second->direction) : 1));
        return true;
    }
    bool operator()(const kinds::Angle& k) const {
        within(k.angle, angle(m.rows.col(0), m.rows.col(1)));
        return true;
    }
    bool operator()(const kinds::Perpendicular&) const {
        EXPECT_NEAR(m.rows.col(0).dot(m.rows.col(1)), 0, 1e-12);
        return true;
    }
    bool operator()(const kinds::Parallel&) const {
        EXPECT_LT(singular_value(m.rows, 1), 1e-12);
        return true;
    }
    bool operator()(const kinds::PolylineLength& k) const {
        double rest = 0;
        for (Eigen::Index i = 0; i + 1 < e.rest.cols(); ++i) rest += length(e.rest, i, i + 1);
        within(k.length, k.absolute, m.rows.colwise().norm().sum(), rest);
        return true;
    }
    bool operator()(const kinds::EqualLengths&) const {
        for (Eigen::Index i = 0; i < m.rows.cols(); ++i) EXPECT_NEAR(m.rows.col(i).norm(), m.rows.col(0).norm(), 1e-12);
        return true;
    }
    bool operator()(const kinds::EqualLength& k) const {
        const Eigen::Index first = k.first - 1;
        EXPECT_NEAR(m.rows.leftCols(first).colwise().norm().sum(), m.rows.rightCols(m.rows.cols() - first).colwise().norm().sum(),
                    1e-12);
        return true;
    }
    bool operator()(const kinds::OnSurface&) const {
        for (Eigen::Index i = 0; i < m.rows.cols(); ++i)
            EXPECT_NEAR((m.rows.col(i) - Vector3d(0.1, 0.2, 0.3)).norm(), 0.7, 1e-12);
        return true;
    }
    bool operator()(const kinds::Bending& k) const {
        within(k.bend, m.rows.norm() / outcome(*make(e), e.rest).rows.norm());
        return true;
    }
};

TEST(Constraint, AdmitsTheNamedShapes) {
    int checked = 0;
    for (const Example& e : examples()) checked += std::visit(Admits{e}, e.kind) ? 1 : 0;
    EXPECT_GT(checked, 40);
}

TEST(Constraint, ConstantsEqualTheirRestValues) {
    for (const Example& e : examples()) {
        const auto c = make(e);
        const std::string_view kind = name_of(e.kind);
        const bool displacement = kind.find("Displacement") != std::string_view::npos;
        const auto* closeness = std::get_if<kinds::Closeness>(&e.kind);
        if (displacement || (closeness != nullptr && !closeness->targets)) {
            EXPECT_LT(c->residual(e.rest), 1e-14) << e.name;
        }
        if (displacement) {
            EXPECT_GT(outcome(*c, e.points).projected.norm(), 0.01) << e.name;
        }
        if (kind == "Laplacian" || kind == "CotangentLaplacian") {
            EXPECT_EQ(outcome(*c, e.points).projected.norm(), 0) << e.name;
        }
        EXPECT_EQ(c->constant(), displacement || kind == "Closeness" || kind == "MeanPosition" || kind == "Laplacian" ||
                                     kind == "CotangentLaplacian");
    }
}

TEST(Constraint, AnglesThatAreTooFarOffCollapseTheShorterSide) {
    Points points(3, 3);
    points.col(0) << 0, 0, 0;
    points.col(1) << 2, 0, 0;
    points.col(2) << 1, 0.1, 0;
    const Outcome o = outcome(*make_constraint(kinds::Angle{{3, 3}}, {0, 1, 2}, 1, points), points);
    EXPECT_EQ(o.projected.col(0), o.rows.col(0));
    EXPECT_EQ(o.projected.col(1).norm(), 0);
}

TEST(Constraint, AFlatBendIsZero) {
    Points rest(3, 4);
    rest.col(0) << 0, 0, 0;
    rest.col(1) << 1, 0.2, 0;
    rest.col(2) << 0.4, 1, 0;
    rest.col(3) << 0.3, -0.7, 0;
    const auto c = make_constraint(kinds::Bending{}, {0, 1, 2, 3}, 1, rest);
    EXPECT_LT(c->residual(rest), 1e-15);
    Points bent = rest;
    bent(2, 3) = 0.2;
    EXPECT_GT(c->residual(bent), 0.05);
}

TEST(Constraint, CotangentLaplacianOfAFlatRingIsZero) {
    Points rest(3, 6);
    rest.col(0) << 0.1, 0.05, 0;
    for (int i = 0; i < 5; ++i) rest.col(i + 1) << std::cos(1.2566 * i), (1 + 0.1 * i) * std::sin(1.2566 * i), 0;
    EXPECT_LT(make_constraint(kinds::CotangentLaplacian{}, first_ids(6), 1, rest)->residual(rest), 1e-12);
    EXPECT_GT(make_constraint(kinds::Laplacian{}, first_ids(6), 1, rest)->residual(rest), 1e-2);
}

TEST(Constraint, SolidsOfRevolutionKeepTheTransformedAxis) {
    // A tilted cylinder: its axis is moved onto the line, up to rotations about it, and its shape is unchanged.
    Points rest(3, 40);
    for (int i = 0; i < 40; ++i) rest.col(i) << std::cos(i), std::sin(i), 0.25 * i;
    const kinds::CoAxiality kind{{0, 1, 0.2}, {4, 5, 6}, Vector3d(0, 0, 1), Vector3d(0, 0, 0)};
    const auto c = make_constraint(kind, first_ids(40), 1, rest);
    const Points points = some_rotation() * rest;
    const Points p = outcome(*c, points).projected;
    const Vector3d d = kind.direction.normalized();
    for (int i = 0; i < 40; ++i) EXPECT_NEAR((p.col(i) - kind.point).cross(d).norm(), 1, 1e-10);
}

TEST(Constraint, StationsShareTheirPoints) {
    const Points rest = random_points(4, 9);
    kinds::AxisOnLine line{{0, 0, 1}, {1, 2, 3}, {0, 0, 1, 1}, {0, 0.25, 0, 0}};
    const auto c = make_constraint(line, first_ids(4), 1, rest);
    const Outcome o = outcome(*c, rest);
    EXPECT_LT((o.rows.col(0) - (rest.col(0) + 0.75 * rest.col(1)) / 1.75).norm(), 1e-15);
    EXPECT_LT((o.rows.col(1) - (0.25 * rest.col(1) + rest.col(2) + rest.col(3)) / 2.25).norm(), 1e-15);
    for (Eigen::Index s = 0; s < 2; ++s) EXPECT_LT((o.projected.col(s) - Vector3d(1, 2, o.rows(2, s))).norm(), 1e-15);
    // Without shares, each point counts for its own station.
    line.shares.assign(4, 0.0);
    const Outcome none = outcome(*make_constraint(line, first_ids(4), 1, rest), rest);
    line.shares.clear();
    EXPECT_EQ(none.rows, outcome(*make_constraint(line, first_ids(4), 1, rest), rest).rows);
    // A station may consist of shares only, also the last one.
    line.shares = {0, 0, 0.5, 0};
    const Outcome last = outcome(*make_constraint(line, first_ids(4), 1, rest), rest);
    ASSERT_EQ(last.rows.cols(), 3);
    EXPECT_EQ(last.rows.col(2), rest.col(2));
    line.stations = {0, 0, 2, 2};
    line.shares = {1, 0, 0, 0};
    EXPECT_EQ(outcome(*make_constraint(line, first_ids(4), 1, rest), rest).rows.col(1), rest.col(0));
}

TEST(Constraint, OneMeasureIsStretchedFromItsAnchors) {
    // A rod from 0 to 4 anchored at its first point, with a required length of 5 to 6; its measure is the height.
    Points rest(3, 5), points(3, 5);
    for (int i = 0; i < 5; ++i) rest.col(i) << 0.1 * i * i, 0, i;
    kinds::Proportion height_kept{{5, 6}, {{0, 4}, Vector3d(0, 0, 2)}};
    height_kept.anchors = {0};
    const auto c = make_constraint(height_kept, first_ids(5), 1, rest);
    EXPECT_EQ(c->map().observed, 0);
    for (const double height : {2.0, 5.5, 9.0}) {
        points = rest;
        points.row(2) *= height / 4;
        Points expected = rest;
        expected.row(2) *= std::clamp(height, 5.0, 6.0) / 4;
        EXPECT_LT((outcome(*c, points).projected - expected).norm(), 1e-14) << height;
    }
    height_kept.anchors.clear();  // about the mean
    points = rest;
    const Points p = outcome(*make_constraint(height_kept, first_ids(5), 1, rest), points).projected;
    EXPECT_NEAR(p(2, 4), 2.5, 1e-14);
    EXPECT_NEAR(p(2, 0), -2.5, 1e-14);
}

}  // namespace
}  // namespace ostraka
