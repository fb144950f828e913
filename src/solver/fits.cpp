// Constraints of points to positions, a surface, a line or a plane.
#include "solver/create.h"

namespace ostraka::solver {

namespace {

class Closeness final : public Constraint {
public:
    Closeness(const ConstraintArguments& a, Points target) : Constraint(a.kind, a.ids, a.weight), target_(std::move(target)) {
        map_.direct = map_.rows = target_.cols();
    }
    void project(const RowsIn&, RowsOut projected) const override { projected = target_; }
    [[nodiscard]] bool constant() const override { return true; }
    void set_target(const Points& target) override {
        if (target.cols() != target_.cols()) fail_usage("the target of Closeness must have a position for each point");
        check_points(target, "target of Closeness");
        target_ = target;
    }

private:
    Points target_;
};

class OnSurface final : public Constraint {
public:
    OnSurface(const ConstraintArguments& a, const kinds::OnSurface& kind)
        : Constraint(a.kind, a.ids, a.weight), closest_(kind.closest_point) {
        map_.direct = map_.rows = static_cast<Eigen::Index>(ids().size());
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        for (Eigen::Index i = 0; i < rows.cols(); ++i) {
            const Eigen::Vector3d found = closest_(rows.col(i));
            projected.col(i) = found.allFinite() ? found : Eigen::Vector3d(rows.col(i));
        }
    }

private:
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> closest_;
};

class Line final : public MomentConstraint {
public:
    using MomentConstraint::MomentConstraint;
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Eigen::Vector3d d = principal(moments.rows).eigenvectors().col(2);
        return {d * d.transpose(), Eigen::Matrix3d::Zero()};
    }
};

class Plane final : public MomentConstraint {
public:
    using MomentConstraint::MomentConstraint;
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Eigen::Vector3d n = principal(moments.rows).eigenvectors().col(0);
        return {Eigen::Matrix3d::Identity() - n * n.transpose(), Eigen::Matrix3d::Zero()};
    }
};

class Orientation final : public MomentConstraint {
public:
    Orientation(const ConstraintArguments& a, const Eigen::Vector3d& n)
        : MomentConstraint(a), plane_(Eigen::Matrix3d::Identity() - n * n.transpose()) {}
    [[nodiscard]] LinearProjection project_moments(const Moments&) const override { return {plane_, Eigen::Matrix3d::Zero()}; }

private:
    Eigen::Matrix3d plane_;
};

}  // namespace

ConstraintPtr create(const kinds::Closeness& kind, const ConstraintArguments& a) {
    return std::make_unique<Closeness>(a, a.given_or_rest(kind.targets));
}
ConstraintPtr create(const kinds::OnSurface& kind, const ConstraintArguments& a) {
    if (!kind.closest_point) a.fail("there is no surface", "give closest_point");
    return std::make_unique<OnSurface>(a, kind);
}
ConstraintPtr create(const kinds::Line&, const ConstraintArguments& a) { return std::make_unique<Line>(a); }
ConstraintPtr create(const kinds::Plane&, const ConstraintArguments& a) { return std::make_unique<Plane>(a); }
ConstraintPtr create(const kinds::Orientation& kind, const ConstraintArguments& a) {
    return std::make_unique<Orientation>(a, a.unit(kind.normal, "normal"));
}

}  // namespace ostraka::solver
