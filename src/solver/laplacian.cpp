// Laplacian constraints (weighted mean of the neighbours minus the point), and bending across an edge.
#include "kinds.h"

#include <cmath>

namespace ostraka::solver {

namespace {

/// One row: the weighted mean of the neighbours minus the point. The projection is zero, or the value of the rest state.
class Laplacian final : public Constraint {
public:
    Laplacian(const Making& m, const std::vector<double>& weights, bool displacement)
        : Constraint(m.kind, m.ids, m.weight), displacement_(displacement) {
        map_.rows = 1;
        map_.entries.reserve(weights.size() + 1);
        map_.entries.push_back({0, 0, -1.0});
        for (std::size_t i = 0; i < weights.size(); ++i)
            map_.entries.push_back({0, static_cast<std::int32_t>(i + 1), weights[i]});
        if (!displacement) return;
        if (m.parameters.target) {
            Laplacian::set_target(*m.parameters.target);
        } else {
            for (std::size_t i = 0; i < weights.size(); ++i)
                target_ += weights[i] * (m.rest.col(static_cast<Eigen::Index>(i + 1)) - m.rest.col(0));
        }
    }
    void project(const RowsIn&, RowsOut projected) const override { projected.col(0) = target_; }
    [[nodiscard]] bool constant() const override { return true; }
    void set_target(const Points& target) override {
        if (!displacement_) Constraint::set_target(target);
        if (target.cols() != 1) fail_usage("the target of " + std::string(kind()) + " is one column");
        check_points(target, "target of " + std::string(kind()));
        target_ = target.col(0);
    }

private:
    Eigen::Vector3d target_ = Eigen::Vector3d::Zero();
    bool displacement_;
};

std::vector<double> uniform(const Making& m) {
    return std::vector<double>(m.ids.size() - 1, 1.0 / static_cast<double>(m.ids.size() - 1));
}

/// Cotangent of the angle at c in the triangle a, b, c; 0 if the triangle is degenerate there.
double cotangent(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    const double sine = (a - c).cross(b - c).norm();
    return sine > 0 ? (a - c).dot(b - c) / sine : 0.0;
}

/// Cotangent weights, divided by the sum of their absolute values, so that the row is a length.
std::vector<double> cotangent_weights(const Making& m) {
    const std::size_t n = m.ids.size() - 1;
    std::vector<double> weights = m.parameters.coefficients;
    if (weights.empty()) {
        if (n < 3) m.fail("a closed ring has at least three neighbours", "give coefficients");
        const auto p = [&](std::size_t i) { return Eigen::Vector3d(m.rest.col(static_cast<Eigen::Index>(1 + i % n))); };
        const Eigen::Vector3d centre = m.rest.col(0);
        for (std::size_t i = 0; i < n; ++i)
            weights.push_back(0.5 * (cotangent(centre, p(i), p(i + 1)) + cotangent(centre, p(i), p(i + n - 1))));
    }
    if (weights.size() != n)
        m.fail("there are " + std::to_string(weights.size()) + " coefficients for " + std::to_string(n) + " neighbours");
    double sum = 0, total = 0;
    for (const double w : weights) {
        if (!std::isfinite(w)) m.fail("a coefficient is not finite");
        sum += std::abs(w);
        total += w;
    }
    // The row must be invariant to translation: the weights have to add up to that of the centre.
    if (!(total > 1e-9 * sum)) m.fail("the coefficients do not add up to a positive number", "use Laplacian here");
    for (double& w : weights) w /= total;
    return weights;
}

/// One row over two triangles 0 1 2 and 0 1 3 that share the edge 0 1; its length measures the bending and is kept in a range
/// (ShapeOp's Bending, without its area factor).
class Bending final : public Constraint {
public:
    Bending(Making&& m, const Eigen::Vector4d& weights) : Constraint(m.kind, std::move(m.ids), m.weight) {
        map_.rows = 1;
        for (int i = 0; i < 4; ++i) map_.entries.push_back({0, i, weights[i]});
        rest_ = (m.rest.colwise() - m.rest.col(0).eval()) * weights;
        range_ = m.range_of(rest_.norm());
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
    Making::Interval range_{0, 0};
};

}  // namespace

std::unique_ptr<Constraint> make_laplacian(Making&& m) { return std::make_unique<Laplacian>(m, uniform(m), false); }
std::unique_ptr<Constraint> make_laplacian_displacement(Making&& m) { return std::make_unique<Laplacian>(m, uniform(m), true); }
std::unique_ptr<Constraint> make_cotangent_laplacian(Making&& m) {
    return std::make_unique<Laplacian>(m, cotangent_weights(m), false);
}
std::unique_ptr<Constraint> make_cotangent_laplacian_displacement(Making&& m) {
    return std::make_unique<Laplacian>(m, cotangent_weights(m), true);
}

std::unique_ptr<Constraint> make_bending(Making&& m) {
    const auto p = [&](int i) { return Eigen::Vector3d(m.rest.col(i)); };
    for (const int opposite : {2, 3})
        if (!((p(1) - p(0)).cross(p(opposite) - p(0)).norm() > 0)) m.fail("a triangle of the rest state has no area");
    const double c02 = cotangent(p(1), p(2), p(0)), c12 = cotangent(p(0), p(2), p(1));
    const double c03 = cotangent(p(1), p(3), p(0)), c13 = cotangent(p(0), p(3), p(1));
    Eigen::Vector4d weights(c12 + c13, c02 + c03, -(c02 + c12), -(c03 + c13));
    weights /= weights.cwiseAbs().maxCoeff();
    return std::make_unique<Bending>(std::move(m), weights);
}

}  // namespace ostraka::solver
