// Groups of points that keep their shape up to a class of motions, and quadrilaterals.
#include "ostraka/core/angles.h"
#include "solver/create.h"

#include <cmath>

namespace ostraka::solver {

namespace {

/// A reference shape, centred. Rows: the centred points.
class ShapeGroup : public MomentConstraint {
protected:
    ShapeGroup(const ConstraintArguments& a, const Points& shape)
        : MomentConstraint(a), shape_(centred(shape)), outer_(outer_sum(shape_, shape_)) {}
    static Points centred(const Points& shape) {
        const Points near = shape.colwise() - shape.col(0).eval();
        return near.colwise() - near.rowwise().mean().eval();
    }

public:
    void set_target(const Points& target) override {
        if (target.cols() != shape_.cols())
            fail_usage("the reference shape of " + std::string(kind()) + " must have as many points as the constraint");
        check_points(target, "reference shape");
        shape_ = centred(target);
        outer_ = outer_sum(shape_, shape_);
    }
    [[nodiscard]] const Points& reference() const override { return shape_; }

protected:
    Points shape_;
    Eigen::Matrix3d outer_;  ///< sum of q_i q_i^T
};

class Similarity final : public ShapeGroup {
public:
    Similarity(const ConstraintArguments& a, const Points& shape, Interval scale) : ShapeGroup(a, shape), scale_(scale) {}
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Eigen::Matrix3d rotation = best_rotation(moments.reference);
        double scale = 1;
        const double size = outer_.trace();
        if (size > 0) scale = rotation.cwiseProduct(moments.reference).sum() / size;
        return {Eigen::Matrix3d::Zero(), scale_.clamp(scale) * rotation};
    }

private:
    Interval scale_;
};

class NonUniformScaling final : public ShapeGroup {
public:
    NonUniformScaling(const ConstraintArguments& a, const Points& shape, const Eigen::Vector3d& axis, Interval scale)
        : ShapeGroup(a, shape), axis_(axis), scale_(scale) {}
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        // The best rotation is known for a given s, and the best s for a given rotation. The squared distance as a function of
        // s alone is smooth but may have several minima, so that it is sampled first.
        const double along = axis_.dot(outer_ * axis_);
        const double maximum = std::sqrt(moments.rows.trace() / (along > 0 ? along : 1.0));
        const double low = scale_.min, high = std::max(low, std::min(scale_.max, 2 * maximum + 1));
        double best = cost(moments, low, along), s = low;
        constexpr int samples = 16;
        for (int i = 1; i <= samples && high > low; ++i) {
            const double at = low + (high - low) * i / samples;
            if (const double here = cost(moments, at, along); here < best) {
                best = here;
                s = at;
            }
        }
        for (int i = 0; i < 200 && along > 0; ++i) {
            const double next =
                scale_.clamp((best_rotation(moments.reference * stretch(s)) * axis_).dot(moments.reference * axis_) / along);
            const bool done = std::abs(next - s) <= 1e-15 * (1 + std::abs(s));
            s = next;
            if (done) break;
        }
        return {Eigen::Matrix3d::Zero(), best_rotation(moments.reference * stretch(s)) * stretch(s)};
    }

private:
    [[nodiscard]] Eigen::Matrix3d stretch(double s) const {
        return Eigen::Matrix3d::Identity() + (s - 1) * axis_ * axis_.transpose();
    }
    /// Squared distance for a given s, without terms that do not depend on s.
    [[nodiscard]] double cost(const Moments& moments, double s, double along) const {
        const Eigen::Matrix3d m = moments.reference * stretch(s);
        return along * s * s - 2 * best_rotation(m).cwiseProduct(m).sum();
    }
    Eigen::Vector3d axis_;
    Interval scale_;
};

/// Corners in cyclic order. Rows: the centred points. The closest parallelogram subtracts a quarter of the alternating sum from
/// each corner; the closest rectangle also gives both diagonals their mean length.
class Quadrilateral final : public Constraint {
public:
    Quadrilateral(const ConstraintArguments& a, bool rectangle) : Constraint(a.kind, a.ids, a.weight), rectangle_(rectangle) {
        map_.direct = map_.rows = 4;
        map_.centred = true;
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        Eigen::Vector3d first = rows.col(0) - rows.col(2), second = rows.col(1) - rows.col(3);
        if (rectangle_) {
            const double a = first.norm(), b = second.norm(), mean = (a + b) / 2;
            if (a > 0 && b > 0) {
                first *= mean / a;
                second *= mean / b;
            } else if (a > 0 || b > 0) {  // one diagonal has zero length: use the other one, rotated by a right angle
                const Eigen::Vector3d known = (a > 0 ? first : second).normalized();
                const Eigen::Vector3d other = mean * any_perpendicular(known);
                (a > 0 ? first : second) = mean * known;
                (a > 0 ? second : first) = other;
            }
        }
        projected.col(0) = first / 2;
        projected.col(1) = second / 2;
        projected.col(2) = -first / 2;
        projected.col(3) = -second / 2;
    }

private:
    bool rectangle_;
};

}  // namespace

ConstraintPtr create(const kinds::Rigid& kind, const ConstraintArguments& a) {
    return std::make_unique<Similarity>(a, a.given_or_rest(kind.shape), Interval{1, 1});
}
ConstraintPtr create(const kinds::Similarity& kind, const ConstraintArguments& a) {
    return std::make_unique<Similarity>(a, a.given_or_rest(kind.shape), a.checked(kind.scale));
}
ConstraintPtr create(const kinds::Equilateral&, const ConstraintArguments& a) {
    Points shape(3, a.rest.cols());
    for (Eigen::Index i = 0; i < shape.cols(); ++i) {
        const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(shape.cols());
        shape.col(i) << std::cos(angle), std::sin(angle), 0;
    }
    return std::make_unique<Similarity>(a, shape, Interval{0, kinds::infinity});
}
ConstraintPtr create(const kinds::NonUniformScaling& kind, const ConstraintArguments& a) {
    return std::make_unique<NonUniformScaling>(a, a.given_or_rest(kind.shape), a.unit(kind.axis, "axis"), a.checked(kind.scale));
}
ConstraintPtr create(const kinds::Parallelogram&, const ConstraintArguments& a) {
    return std::make_unique<Quadrilateral>(a, false);
}
ConstraintPtr create(const kinds::Rectangle&, const ConstraintArguments& a) { return std::make_unique<Quadrilateral>(a, true); }

}  // namespace ostraka::solver
