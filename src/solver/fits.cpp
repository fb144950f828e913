// Constraints of points to positions, a surface, a line or a plane.
#include "kinds.h"

namespace ostraka::solver {

namespace {

/// The points x_i are at target positions. Rows: the points.
class Closeness final : public Constraint {
public:
    explicit Closeness(Making&& m) : Constraint(m.kind, std::move(m.ids), m.weight), target_(m.target_or(m.rest)) {
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

/// The points x_i are on a surface. Rows: the points.
class OnSurface final : public Constraint {
public:
    explicit OnSurface(Making&& m) : Constraint(m.kind, std::move(m.ids), m.weight), closest_(m.parameters.closest_point) {
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

/// The points are on a line: the first principal axis (ShapeUp, section 4).
class Line final : public MomentConstraint {
public:
    using MomentConstraint::MomentConstraint;
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Eigen::Vector3d d = principal(moments.rows).eigenvectors().col(2);
        return {d * d.transpose(), Eigen::Matrix3d::Zero()};
    }
};

/// The points are on a plane: the one perpendicular to the last principal axis.
class Plane final : public MomentConstraint {
public:
    using MomentConstraint::MomentConstraint;
    [[nodiscard]] LinearProjection project_moments(const Moments& moments) const override {
        const Eigen::Vector3d n = principal(moments.rows).eigenvectors().col(0);
        return {Eigen::Matrix3d::Identity() - n * n.transpose(), Eigen::Matrix3d::Zero()};
    }
};

/// The points are on a plane with given normal (the thesis, section 5.2.1).
class Orientation final : public MomentConstraint {
public:
    Orientation(const Making& m, const Eigen::Vector3d& n)
        : MomentConstraint(m), plane_(Eigen::Matrix3d::Identity() - n * n.transpose()) {}
    [[nodiscard]] LinearProjection project_moments(const Moments&) const override { return {plane_, Eigen::Matrix3d::Zero()}; }

private:
    Eigen::Matrix3d plane_;
};

}  // namespace

std::unique_ptr<Constraint> make_closeness(Making&& m) { return std::make_unique<Closeness>(std::move(m)); }

std::unique_ptr<Constraint> make_on_surface(Making&& m) {
    if (!m.parameters.closest_point) m.fail("there is no surface", "give closest_point");
    return std::make_unique<OnSurface>(std::move(m));
}

std::unique_ptr<Constraint> make_line(Making&& m) { return std::make_unique<Line>(m); }
std::unique_ptr<Constraint> make_plane(Making&& m) { return std::make_unique<Plane>(m); }

std::unique_ptr<Constraint> make_orientation(Making&& m) { return std::make_unique<Orientation>(m, m.direction()); }

}  // namespace ostraka::solver
