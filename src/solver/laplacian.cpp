// Laplacian constraints (weighted mean of the neighbours minus the point), and bending across an edge.
#include "solver/create.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka::solver {

namespace {

/// One row: the weighted mean of the neighbours minus the point.
class Laplacian final : public Constraint {
public:
    /// The projection is zero.
    Laplacian(const ConstraintArguments& a, const std::vector<double>& weights)
        : Constraint(a.kind, a.ids, a.weight), displacement_(false) {
        map_.rows = 1;
        map_.entries.reserve(weights.size() + 1);
        map_.entries.push_back({0, 0, -1.0});
        for (std::size_t i = 0; i < weights.size(); ++i)
            map_.entries.push_back({0, static_cast<std::int32_t>(i + 1), weights[i]});
    }
    /// The projection is the displacement or, by default, the row of the rest state.
    Laplacian(const ConstraintArguments& a, const std::vector<double>& weights,
              const std::optional<Eigen::Vector3d>& displacement)
        : Laplacian(a, weights) {
        displacement_ = true;
        if (displacement) {
            Laplacian::set_target(*displacement);
        } else {
            for (std::size_t i = 0; i < weights.size(); ++i)
                target_ += weights[i] * (a.rest.col(static_cast<Eigen::Index>(i + 1)) - a.rest.col(0));
        }
    }
    void project(const RowsIn&, RowsOut projected) const override { projected.col(0) = target_; }
    [[nodiscard]] bool constant() const override { return true; }
    void set_target(const Points& target) override {
        if (!displacement_) Constraint::set_target(target);
        if (target.cols() != 1) fail_usage(fmt::format("the target of {} is one column", kind()));
        check_points(target, fmt::format("target of {}", kind()));
        target_ = target.col(0);
    }

private:
    Eigen::Vector3d target_ = Eigen::Vector3d::Zero();
    bool displacement_;
};

std::vector<double> uniform(const ConstraintArguments& a) {
    return std::vector<double>(a.ids.size() - 1, 1.0 / static_cast<double>(a.ids.size() - 1));
}

/// Cotangent of the angle at c in the triangle a, b, c; 0 if the triangle is degenerate there.
double cotangent(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const double sine = (a - c).cross(b - c).norm();
    return sine > 0 ? (a - c).dot(b - c) / sine : 0.0;
}

/// The given weights, otherwise cotangent weights, divided by the sum of their absolute values, so that the row is a length.
std::vector<double> cotangent_weights(const ConstraintArguments& a, std::vector<double> weights) {
    const std::size_t n = a.ids.size() - 1;
    if (weights.empty()) {
        if (n < 3) a.fail("a closed ring has at least three neighbours", "give weights");
        const auto p = [&](std::size_t i) { return Eigen::Vector3d(a.rest.col(static_cast<Eigen::Index>(1 + i % n))); };
        const Eigen::Vector3d centre = a.rest.col(0);
        for (std::size_t i = 0; i < n; ++i)
            weights.push_back(0.5 * (cotangent(centre, p(i), p(i + 1)) + cotangent(centre, p(i), p(i + n - 1))));
    }
    if (weights.size() != n) a.fail(fmt::format("there are {} weights for {} neighbours", weights.size(), n));
    double sum = 0, total = 0;
    for (const double w : weights) {
        if (!std::isfinite(w)) a.fail("a weight is not finite");
        sum += std::abs(w);
        total += w;
    }
    // The row must be invariant to translation: the weights have to add up to that of the centre.
    if (!(total > 1e-9 * sum)) a.fail("the weights do not add up to a positive number", "use Laplacian here");
    for (double& w : weights) w /= total;
    return weights;
}

class Bending final : public Constraint {
public:
    Bending(const ConstraintArguments& a, const kinds::Bending& kind, const Eigen::Vector4d& weights)
        : Constraint(a.kind, a.ids, a.weight) {
        map_.rows = 1;
        for (int i = 0; i < 4; ++i) map_.entries.push_back({0, i, weights[i]});
        rest_ = (a.rest.colwise() - a.rest.col(0).eval()) * weights;
        range_ = a.range_of(kind.bend, kind.absolute, rest_.norm());
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        const double length = rows.col(0).norm();
        const double wanted = range_.clamp(length);
        if (length > 0) {
            projected.col(0) = rows.col(0) * (wanted / length);
        } else {
            const double rest = rest_.norm();
            projected.col(0) = rest > 0 ? Eigen::Vector3d(rest_ * (wanted / rest)) : Eigen::Vector3d(0, 0, wanted);
        }
    }

private:
    Eigen::Vector3d rest_;
    Interval range_{0, 0};
};

}  // namespace

ConstraintPtr create(const kinds::Laplacian&, const ConstraintArguments& a) { return std::make_unique<Laplacian>(a, uniform(a)); }
ConstraintPtr create(const kinds::LaplacianDisplacement& kind, const ConstraintArguments& a) {
    return std::make_unique<Laplacian>(a, uniform(a), kind.displacement);
}
ConstraintPtr create(const kinds::CotangentLaplacian& kind, const ConstraintArguments& a) {
    return std::make_unique<Laplacian>(a, cotangent_weights(a, kind.weights));
}
ConstraintPtr create(const kinds::CotangentLaplacianDisplacement& kind, const ConstraintArguments& a) {
    return std::make_unique<Laplacian>(a, cotangent_weights(a, kind.weights), kind.displacement);
}
ConstraintPtr create(const kinds::Bending& kind, const ConstraintArguments& a) {
    const auto p = [&](int i) { return Eigen::Vector3d(a.rest.col(i)); };
    for (const int opposite : {2, 3})
        if (!((p(1) - p(0)).cross(p(opposite) - p(0)).norm() > 0)) a.fail("a triangle of the rest state has no area");
    const double c02 = cotangent(p(1), p(2), p(0)), c12 = cotangent(p(0), p(2), p(1));
    const double c03 = cotangent(p(1), p(3), p(0)), c13 = cotangent(p(0), p(3), p(1));
    Eigen::Vector4d weights(c12 + c13, c02 + c03, -(c02 + c12), -(c03 + c13));
    weights /= weights.cwiseAbs().maxCoeff();
    return std::make_unique<Bending>(a, kind, weights);
}

}  // namespace ostraka::solver
