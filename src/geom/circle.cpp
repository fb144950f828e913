// Circle fits, and integrals of the distance from a circle along straight pieces.
#include "ostraka/geom/circle.h"
#include "ostraka/core/dense.h"

#include <Eigen/LU>

#include <array>
#include <cmath>

namespace ostraka {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

/// Nodes and weights of Gauss-Legendre quadrature on -1 to 1.
constexpr std::array<std::array<double, 2>, 3> gauss3{
    {{-0.7745966692414834, 5.0 / 9}, {0, 8.0 / 9}, {0.7745966692414834, 5.0 / 9}}};
constexpr std::array<std::array<double, 2>, 8> gauss8{{{-0.9602898564975363, 0.1012285362903763},
                                                       {-0.7966664774136267, 0.2223810344533745},
                                                       {-0.5255324099163290, 0.3137066458778873},
                                                       {-0.1834346424956498, 0.3626837833783620},
                                                       {0.1834346424956498, 0.3626837833783620},
                                                       {0.5255324099163290, 0.3137066458778873},
                                                       {0.7966664774136267, 0.2223810344533745},
                                                       {0.9602898564975363, 0.1012285362903763}}};

/// The distance from the centre continues to complex places along the piece but for square roots at a distance of it: with pieces
/// of at most a quarter (1/60) of it, 8 (3) nodes err by 8^-16 (120^-6).
template <class F>
void integrate_piece(const Vector2d& a, const Vector2d& b, const Vector2d& centre, F&& f, int depth = 0) {
    const Vector2d middle = (a + b) / 2, half = (b - a) / 2;
    const double length = half.norm(), distance = (middle - centre).norm();
    if (!(length > 0)) return;
    const auto add = [&](const auto& rule) {
        for (const auto& [t, w] : rule) f(Vector2d(middle + t * half), w * length);
    };
    if (distance >= 60 * length) add(gauss3);
    else if (distance >= 4 * length || depth == 40) add(gauss8);
    else {
        integrate_piece(a, middle, centre, f, depth + 1);
        integrate_piece(middle, b, centre, f, depth + 1);
    }
}

/// Sums of the fit at a centre, with the radius that is best there.
struct Fit {
    double length = 0, radius = 0, square = 0;  ///< square: mean of (d - radius)^2
    Vector2d gradient = Vector2d::Zero();       ///< of square / 2
    Vector2d downhill = Vector2d::Zero();       ///< where the Hessian is negative: a direction in which it is
    Matrix2d hessian = Matrix2d::Zero();        ///< of square / 2, or Gauss-Newton's where that is not positive
};

Fit fit_at(const PlaneSegments& segments, const Vector2d& centre, double guess) {
    Fit fit;
    double first = 0, second = 0;
    Vector2d unit = Vector2d::Zero(), moment = Vector2d::Zero();
    Matrix2d units = Matrix2d::Zero(), bend = Matrix2d::Zero();
    for (const auto& [a, b] : segments)
        integrate_piece(a, b, centre, [&](const Vector2d& p, double w) {
            const Vector2d q = p - centre;
            const double d = q.norm(), e = d - guess;
            if (!(d > 0)) return;
            const Vector2d n = q / d;
            fit.length += w, first += w * e, second += w * e * e;
            unit += w * n, moment += w * e * n, units += w * n * n.transpose();
            bend += w / d * (Matrix2d::Identity() - n * n.transpose());
        });
    if (!(fit.length > 0)) return fit;
    const double mean = first / fit.length;
    unit /= fit.length;
    fit.radius = guess + mean;
    fit.square = std::max(0.0, second / fit.length - mean * mean);
    fit.gradient = -(moment / fit.length - mean * unit);
    // d^2 has the Hessian 2 I, d has (I - n n^T) / d.
    fit.hessian = Matrix2d::Identity() - unit * unit.transpose() - fit.radius / fit.length * bend;
    const SymmetricEigen2 solver(fit.hessian);
    if (solver.eigenvalues()[0] < 0) fit.downhill = solver.eigenvectors().col(0);
    if (!(solver.eigenvalues()[0] > 1e-12)) fit.hessian = units / fit.length - unit * unit.transpose();
    return fit;
}

}  // namespace

Circle fit_circle(const std::vector<Vector2d>& points, const std::vector<double>& weights) {
    Vector2d mean = Vector2d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) mean += weights[i] * points[i], total += weights[i];
    if (!(total > 0)) return {};
    mean /= total;
    // |q|^2 = 2 c . q + (r^2 - |c|^2) about the mean.
    Matrix2d A = Matrix2d::Zero();
    Vector2d b = Vector2d::Zero();
    double square = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector2d q = points[i] - mean;
        A += weights[i] * q * q.transpose();
        b += weights[i] * q.squaredNorm() * q / 2;
        square += weights[i] * q.squaredNorm();
    }
    const double determinant = A.determinant();
    if (!(determinant > 1e-12 * A.trace() * A.trace())) return {};
    const Vector2d c = A.inverse() * b;
    return {mean + c, std::sqrt(square / total + c.squaredNorm())};
}

Circle fit_circle(const PlaneSegments& segments) {
    // Two nodes a piece integrate the third-degree terms of the algebraic fit exactly.
    std::vector<Vector2d> points;
    std::vector<double> weights;
    for (const auto& [a, b] : segments)
        for (const double t : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)})
            points.push_back(a + t * (b - a)), weights.push_back((b - a).norm());
    Circle circle = fit_circle(points, weights);
    if (circle.radius < 0) return circle;
    Fit fit = fit_at(segments, circle.centre, circle.radius);
    double damping = 0;
    for (int step = 0, leaps = 0; step < 60; ++step) {
        // A place that is best along one direction and worst along the other is left, to the side of the larger coordinates.
        if (fit.gradient.norm() < 1e-9 * fit.radius && fit.downhill.norm() > 0 && leaps++ < 2) {
            const Vector2d side = fit.downhill.sum() < 0 ? Vector2d(-fit.downhill) : fit.downhill;
            circle.centre += 0.01 * fit.radius * side;
            fit = fit_at(segments, circle.centre, fit.radius);
            continue;
        }
        const Matrix2d H = fit.hessian + damping * Matrix2d::Identity();
        const Vector2d move = -H.inverse() * fit.gradient;
        if (!(move.norm() > 1e-15 * fit.radius)) break;
        const Fit next = fit_at(segments, circle.centre + move, fit.radius);
        if (!(next.square <= fit.square * (1 + 1e-12))) {  // what is above by rounding only is no worse
            if (damping > 1e6) break;
            damping = std::max(1e-3, 10 * damping);
            continue;
        }
        circle.centre += move;
        fit = next;
        damping = damping > 1e-6 ? damping / 10 : 0;
        if (move.norm() < 1e-12 * fit.radius) break;
    }
    circle.radius = fit.radius;
    return circle;
}

CircleDeviation circle_deviation(const PlaneSegments& segments, const Circle& circle) {
    CircleDeviation deviation;
    double length = 0;
    const auto add = [&](const Vector2d& a, const Vector2d& b) {
        integrate_piece(a, b, circle.centre, [&](const Vector2d& p, double w) {
            const double d = (p - circle.centre).norm();
            // (d^2 - r^2) / (d + r) would keep no more digits: d and r are rounded once each.
            const double e = std::abs(d - circle.radius);
            deviation.absolute += w * e, deviation.square += w * e * e, length += w;
        });
    };
    for (const auto& [a, b] : segments) {
        // |d - r| has a kink where the piece crosses the circle: it is cut there.
        const Vector2d along = b - a, from = a - circle.centre;
        const double A = along.squaredNorm(), B = from.dot(along), C = from.squaredNorm() - circle.radius * circle.radius;
        const double root = B * B - A * C;
        std::array<double, 4> cuts{0, 1, 1, 1};
        if (A > 0 && root > 0) {
            cuts[1] = std::clamp((-B - std::sqrt(root)) / A, 0.0, 1.0);
            cuts[2] = std::clamp((-B + std::sqrt(root)) / A, 0.0, 1.0);
        }
        for (std::size_t k = 0; k < 3; ++k)
            if (cuts.at(k) < cuts.at(k + 1)) add(a + cuts.at(k) * along, a + cuts.at(k + 1) * along);
    }
    if (length > 0) deviation.absolute /= length, deviation.square /= length;
    return deviation;
}

}  // namespace ostraka
