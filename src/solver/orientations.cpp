// Groups that are rotated rigidly: to a plane normal, onto an axis, to an angle with a direction.
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "solver/create.h"

#include <cmath>

namespace ostraka::solver {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

Matrix3d cross_matrix(const Vector3d& n) {
    Matrix3d m;
    m << 0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0;
    return m;
}

/// The rotation R with R a = d or R a = -d that maximises tr(R m): the rotation from a to +-d, followed by a rotation about d,
/// whose angle has a closed form.
Matrix3d rotation_to(const Vector3d& a, const Vector3d& d, const Matrix3d& m) {
    Matrix3d best = Matrix3d::Identity();
    double maximum = -std::numeric_limits<double>::infinity();
    for (const double side : {1.0, -1.0}) {
        const Matrix3d rotation = rotation_between(a, side * d).toRotationMatrix();
        const Matrix3d rotated = rotation * m;
        const double along = d.dot(rotated * d), c = rotated.trace() - along, s = (cross_matrix(d) * rotated).trace();
        const double value = along + std::hypot(c, s);
        if (value > maximum) {
            maximum = value;
            best = Eigen::AngleAxisd(c == 0 && s == 0 ? 0.0 : std::atan2(s, c), d).toRotationMatrix() * rotation;
        }
    }
    return best;
}

/// The rotation R with d . R a = cos(angle), 0 < angle < pi, that maximises tr(R m) for a symmetric m. In unit quaternions q
/// these are q^T C q = cos(angle) and q^T N q. The joint range of the two forms on the sphere is convex (Brickman 1961), so
/// that the best q is a top eigenvector of N + l C for some l, which is found by bisection, since q^T C q grows with l.
Matrix3d rotation_to_angle(const Vector3d& a, const Vector3d& d, double angle, const Matrix3d& m) {
    const double size = m.norm();
    if (!(size > 0)) return Matrix3d::Identity();  // all points coincide
    Matrix4d n = Matrix4d::Zero(), c;
    n(0, 0) = m.trace() / size;
    n.bottomRightCorner<3, 3>() = 2 * m / size - n(0, 0) * Matrix3d::Identity();
    c(0, 0) = a.dot(d);
    c.bottomLeftCorner<3, 1>() = a.cross(d);
    c.topRightCorner<1, 3>() = a.cross(d).transpose();
    c.bottomRightCorner<3, 3>() = a * d.transpose() + d * a.transpose() - c(0, 0) * Matrix3d::Identity();
    // C has the eigenvalues 1, 1, -1, -1; the norm of q in each eigenspace determines the angle.
    const Matrix4d near = (Matrix4d::Identity() + c) / 2, far = (Matrix4d::Identity() - c) / 2;
    const double wanted = std::pow(std::sin(angle / 2), 2);
    const auto too_far = [&](const Vector4d& q) { return (far * q).squaredNorm() > wanted * q.squaredNorm(); };
    const auto top = [&](double l) -> Vector4d { return SymmetricEigenX(n + l * c).eigenvectors().col(3); };
    constexpr double maximum = 1e12;
    double low = -1, high = 1;
    while (low > -maximum && !too_far(top(low))) low *= 2;
    while (high < maximum && too_far(top(high))) high *= 2;
    while (high - low > 1e-16 * std::max(1.0, std::abs(low))) {
        const double middle = low + (high - low) / 2;
        if (!(middle > low && middle < high)) break;
        (too_far(top(middle)) ? low : high) = middle;
    }
    // Both limits are equal unless the top eigenvalue is double; then the solution is a mixture of both eigenvectors.
    const Vector4d before = top(low);
    Vector4d after = top(high);
    if (before.dot(after) < 0) after = -after;
    double from = 0, to = 1;
    for (int i = 0; i < 60; ++i) {
        const double share = (from + to) / 2;
        (too_far((1 - share) * before + share * after) ? from : to) = share;
    }
    const Vector4d mixed = (1 - to) * before + to * after;
    const Vector4d q = std::cos(angle / 2) * (near * mixed).normalized() + std::sin(angle / 2) * (far * mixed).normalized();
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

/// Direction of the axis in the rest state; by default the longest principal axis of the centred shape.
Vector3d rest_axis_of(const ConstraintArguments& a, const std::optional<Vector3d>& direction, const Points& shape) {
    return direction ? a.unit(*direction, "direction of the rest axis")
                     : Vector3d(principal(outer_sum(shape, shape)).eigenvectors().col(2));
}

/// The mean, computed relative to the first point, so that no digits are lost in the sum far from the origin.
Vector3d mean_of(const Points& points) { return points.col(0) + (points.colwise() - points.col(0).eval()).rowwise().mean(); }

class FittedPlaneOrientation final : public MomentConstraint {
public:
    FittedPlaneOrientation(const ConstraintArguments& a, const Vector3d& normal) : MomentConstraint(a), normal_(normal) {}
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Vector3d fitted = principal(moments.rows).eigenvectors().col(0);
        return {rotation_to(fitted, normal_, moments.rows), Matrix3d::Zero()};
    }

private:
    Vector3d normal_;
};

class CoAxiality final : public Constraint {
public:
    CoAxiality(const ConstraintArguments& a, const kinds::CoAxiality& kind)
        : Constraint(a.kind, a.ids, a.weight), direction_(a.unit(kind.direction)), point_(a.finite(kind.point)) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
        const Vector3d mean = mean_of(a.rest);
        shape_ = a.rest.colwise() - mean;
        rest_axis_ = rest_axis_of(a, kind.rest_direction, shape_);
        if (kind.rest_point) to_mean_ = mean - a.finite(*kind.rest_point, "point of the rest axis");
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        const Vector3d first = rows.col(0);
        Points z = rows.colwise() - first;
        const Vector3d offset = z.rowwise().mean();
        z.colwise() -= offset;
        const Vector3d mean = first + offset;
        const Matrix3d carried = best_rotation(outer_sum(z, shape_));
        const Vector3d axis = carried * rest_axis_, b = carried * to_mean_;
        const Matrix3d across = Matrix3d::Identity() - direction_ * direction_.transpose();
        const Vector3d gap = across * (point_ - mean);
        const auto count = static_cast<double>(rows.cols());
        const Matrix3d rotation = rotation_to(axis, direction_, outer_sum(z, z) - count * b * gap.transpose());
        const Vector3d to = mean + across * (rotation * b) + gap;
        for (Index i = 0; i < rows.cols(); ++i) projected.col(i) = rotation * z.col(i) + to;
    }

private:
    Vector3d direction_, point_, rest_axis_, to_mean_ = Vector3d::Zero();
    Points shape_;
};

class AxisDirection final : public MomentConstraint {
public:
    AxisDirection(const ConstraintArguments& a, const kinds::AxisDirection& kind)
        : MomentConstraint(a), direction_(a.unit(kind.direction)), range_(a.checked(kind.angle)) {
        if (range_.max > pi / 2) a.fail("an angle between axes is at most pi / 2", "angles are in radians");
        shape_ = a.rest.colwise() - mean_of(a.rest);
        if (!(shape_.cwiseAbs().maxCoeff() > 0)) a.fail("the rest points are all at one place");
        rest_axis_ = rest_axis_of(a, kind.rest_direction, shape_);
        if (!kind.min_size) return;
        const Points size = a.given_or_rest(kind.min_size);
        minimum_ = (size.colwise() - mean_of(size)).squaredNorm() / 4;
    }
    [[nodiscard]] const Points& reference() const override { return shape_; }
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Vector3d axis = best_rotation(moments.reference) * rest_axis_;
        const double now = std::atan2(axis.cross(direction_).norm(), std::abs(axis.dot(direction_))), wanted = range_.clamp(now);
        // Coincident points satisfy any angle; the minimum size prevents this as a solution of contradictory constraints.
        const double size = moments.rows.trace(), grown = size > 0 && size < minimum_ ? std::sqrt(minimum_ / size) : 1;
        if (wanted == now) return {grown * Matrix3d::Identity(), Matrix3d::Zero()};
        if (!(wanted > 0)) return {grown * rotation_to(axis, direction_, moments.rows), Matrix3d::Zero()};
        const Matrix3d one = rotation_to_angle(axis, direction_, wanted, moments.rows);
        const Matrix3d other = rotation_to_angle(axis, -direction_, wanted, moments.rows);
        const auto value = [&](const Matrix3d& rotation) { return rotation.cwiseProduct(moments.rows).sum(); };
        return {grown * (value(one) >= value(other) ? one : other), Matrix3d::Zero()};
    }

private:
    Vector3d direction_, rest_axis_;
    double minimum_ = 0;  ///< lower bound of the sum of squared distances from the mean
    Interval range_;
    Points shape_;
};

}  // namespace

ConstraintPtr create(const kinds::FittedPlaneOrientation& kind, const ConstraintArguments& a) {
    return std::make_unique<FittedPlaneOrientation>(a, a.unit(kind.normal, "normal"));
}
ConstraintPtr create(const kinds::CoAxiality& kind, const ConstraintArguments& a) {
    return std::make_unique<CoAxiality>(a, kind);
}
ConstraintPtr create(const kinds::AxisDirection& kind, const ConstraintArguments& a) {
    return std::make_unique<AxisDirection>(a, kind);
}

}  // namespace ostraka::solver
