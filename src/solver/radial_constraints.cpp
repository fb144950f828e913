// Circles and spheres: geometric least squares by damped Gauss-Newton, initialised by the algebraic fit.
#include "ostraka/algebra/dense.h"
#include "solver/create.h"

#include <cmath>

namespace ostraka::solver {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Levenberg-Marquardt least squares. `normal(state, JtJ, Jtf)` returns the cost at a state and fills the matrices;
/// `step(state, d)` returns the state after a step.
template <int N, class State, class Normal, class Step>
double minimise(State& state, const Normal& normal, const Step& step) {
    using Square = Eigen::Matrix<double, N, N>;
    using Column = Eigen::Matrix<double, N, 1>;
    Square jj, next_jj;
    Column jf, next_jf;
    double cost = normal(state, jj, jf), damping = 1e-6;
    for (int i = 0; i < 200 && cost > 0; ++i) {
        const Square system = jj + damping * (Square(jj.diagonal().asDiagonal()) + 1e-14 * jj.trace() * Square::Identity());
        const Column d = -solve_ldlt<N>(system, jf);
        if (!d.allFinite()) break;
        const State next = step(state, d);
        const double next_cost = normal(next, next_jj, next_jf);
        if (next_cost < cost) {
            const bool done = cost - next_cost <= 1e-15 * cost && d.norm() < 1e-13;
            state = next;
            cost = next_cost;
            jj = next_jj;
            jf = next_jf;
            damping = std::max(damping / 10, 1e-14);
            if (done) break;
        } else {
            damping *= 10;
            if (damping > 1e12) break;
        }
    }
    return cost;
}

/// Rows: the centred points.
class RadialConstraint : public Constraint {
public:
    explicit RadialConstraint(const ConstraintArguments& a) : Constraint(a.kind, a.ids, a.weight) {
        map_.direct = map_.rows = static_cast<Index>(ids().size());
        map_.centred = true;
    }

protected:
    /// Root mean square distance from the mean.
    static double size_of(const RowsIn& rows) { return rows.norm() / std::sqrt(static_cast<double>(rows.cols())); }
    /// Centre of the circle or sphere in D dimensions that best fits |x|^2 = 2 c . x + e (Kasa).
    template <int D>
    static Eigen::Matrix<double, D, 1> algebraic_centre(const Eigen::Matrix<double, D, Eigen::Dynamic>& x) {
        Eigen::Matrix<double, D + 1, D + 1> normal = Eigen::Matrix<double, D + 1, D + 1>::Zero();
        Eigen::Matrix<double, D + 1, 1> right = Eigen::Matrix<double, D + 1, 1>::Zero();
        for (Index i = 0; i < x.cols(); ++i) {
            Eigen::Matrix<double, D + 1, 1> row;
            row << 2 * x.col(i), 1;
            normal += row * row.transpose();
            right += row * x.col(i).squaredNorm();
        }
        const Eigen::Matrix<double, D + 1, 1> found = solve_least_squares(normal, right);
        return found.template head<D>();
    }
};

class Sphere final : public RadialConstraint {
public:
    using RadialConstraint::RadialConstraint;
    void project(const RowsIn& rows, RowsOut projected) const override {
        projected = rows;
        const double size = size_of(rows);
        if (!(size > 0)) return;
        const Points x = rows / size;
        Vector3d centre = algebraic_centre<3>(x);
        if (!centre.allFinite()) return;
        const auto radius_at = [&](const Vector3d& c) { return (x.colwise() - c).colwise().norm().mean(); };
        const auto normal = [&](const Vector3d& c, Matrix3d& jj, Vector3d& jf) {
            const double radius = radius_at(c);
            Vector3d mean = Vector3d::Zero();
            for (Index i = 0; i < x.cols(); ++i) mean += (x.col(i) - c).stableNormalized();
            mean /= static_cast<double>(x.cols());
            jj.setZero();
            jf.setZero();
            double cost = 0;
            for (Index i = 0; i < x.cols(); ++i) {
                const Vector3d v = x.col(i) - c;
                const double f = v.norm() - radius;
                const Vector3d j = mean - v.stableNormalized();
                jj += j * j.transpose();
                jf += j * f;
                cost += f * f;
            }
            return cost;
        };
        const double cost = minimise<3>(centre, normal, [](const Vector3d& c, const Vector3d& d) { return Vector3d(c + d); });
        const auto axes = principal(outer_sum(x, x));
        if (axes.eigenvalues()[0] < cost) {
            const Vector3d n = axes.eigenvectors().col(0);
            projected = rows - n * (n.transpose() * rows);
            return;
        }
        const double radius = radius_at(centre);
        for (Index i = 0; i < x.cols(); ++i) {
            const Vector3d v = x.col(i) - centre;
            const double length = v.norm();
            projected.col(i) = size * (centre + radius * (length > 0 ? Vector3d(v / length) : Vector3d::UnitX()));
        }
    }
};

class Circle final : public RadialConstraint {
public:
    using RadialConstraint::RadialConstraint;
    void project(const RowsIn& rows, RowsOut projected) const override {
        projected = rows;
        const double size = size_of(rows);
        if (!(size > 0)) return;
        const Points x = rows / size;
        const auto axes = principal(outer_sum(x, x));
        Ring ring;
        ring.normal = axes.eigenvectors().col(0);
        const Eigen::Matrix<double, 3, 2> plane = axes.eigenvectors().rightCols<2>();
        ring.centre = plane * algebraic_centre<2>(plane.transpose() * x);
        if (!ring.centre.allFinite()) return;
        ring.radius = 0;
        for (Index i = 0; i < x.cols(); ++i) ring.radius += across(ring, x.col(i)).norm() / static_cast<double>(x.cols());
        const double cost = minimise<6>(
            ring, [&](const Ring& at, auto& jj, auto& jf) { return equations(at, x, jj, jf); },
            [](const Ring& at, const Eigen::Matrix<double, 6, 1>& d) {
                Ring next;
                const Vector3d s = any_perpendicular(at.normal), t = at.normal.cross(s);
                next.normal = (at.normal + d[3] * s + d[4] * t).normalized();
                next.centre = at.centre + d.head<3>();
                next.radius = at.radius + d[5];
                return next;
            });
        if (axes.eigenvalues()[0] + axes.eigenvalues()[1] < cost) {
            const Vector3d d = axes.eigenvectors().col(2);
            projected = d * (d.transpose() * rows);
            return;
        }
        for (Index i = 0; i < x.cols(); ++i) {
            const Vector3d w = across(ring, x.col(i));
            const double length = w.norm();
            projected.col(i) =
                size * (ring.centre + ring.radius * (length > 0 ? Vector3d(w / length) : any_perpendicular(ring.normal)));
        }
    }

private:
    struct Ring {
        Vector3d centre, normal;
        double radius = 0;
    };
    static Vector3d across(const Ring& ring, const Vector3d& x) {
        const Vector3d v = x - ring.centre;
        return v - ring.normal.dot(v) * ring.normal;
    }
    /// Two residuals per point: its height above the plane, and its distance from the axis minus the radius.
    static double equations(const Ring& ring, const Points& x, Eigen::Matrix<double, 6, 6>& jj, Eigen::Matrix<double, 6, 1>& jf) {
        const Vector3d& n = ring.normal;
        const Vector3d s = any_perpendicular(n), t = n.cross(s);
        jj.setZero();
        jf.setZero();
        double cost = 0;
        for (Index i = 0; i < x.cols(); ++i) {
            const Vector3d v = x.col(i) - ring.centre;
            const double z = n.dot(v);
            const Vector3d w = v - z * n;
            const double rho = w.norm();
            const Vector3d e = rho > 0 ? Vector3d(w / rho) : s;
            Eigen::Matrix<double, 6, 1> height, radial;
            height << -n, v.dot(s), v.dot(t), 0;
            const double lean = rho > 0 ? -z / rho : 0.0;
            radial << -e, lean * v.dot(s), lean * v.dot(t), -1;
            const double f = rho - ring.radius;
            jj += height * height.transpose() + radial * radial.transpose();
            jf += height * z + radial * f;
            cost += z * z + f * f;
        }
        return cost;
    }
};

}  // namespace

ConstraintPtr create(const kinds::Sphere&, const ConstraintArguments& a) { return std::make_unique<Sphere>(a); }
ConstraintPtr create(const kinds::Circle&, const ConstraintArguments& a) { return std::make_unique<Circle>(a); }

}  // namespace ostraka::solver
