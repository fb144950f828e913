// Circle fits, and integrals of the distance from a circle along segments.
#include "ostraka/geom/circle.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

#include <Eigen/LU>

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
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

/// The distance from the centre, continued to complex parameters along the segment, is analytic except for branch points at
/// that distance. For segments of at most a quarter (1/60) of the distance, 8 (3) nodes have errors of 8^-16 (120^-6).
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

/// Sums of the fit for a given centre, with the best radius for it.
struct Fit {
    double length = 0, radius = 0, square = 0;  ///< square: mean of (d - radius)^2
    Vector2d gradient = Vector2d::Zero();       ///< of square / 2
    Vector2d downhill = Vector2d::Zero();       ///< if the Hessian has a negative eigenvalue: its eigenvector
    Matrix2d hessian = Matrix2d::Zero();        ///< of square / 2; Gauss-Newton approximation if not positive definite
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

/// Points of an arc sorted by their angle around the centre, starting after the widest gap.
std::vector<Vector2d> in_order(std::vector<Vector2d> places, const Vector2d& centre) {
    std::vector<std::pair<double, std::size_t>> angles;
    for (std::size_t i = 0; i < places.size(); ++i)
        angles.emplace_back(std::atan2(places[i].y() - centre.y(), places[i].x() - centre.x()), i);
    std::sort(angles.begin(), angles.end());
    std::size_t first = 0;
    double widest = angles.front().first + 2 * pi - angles.back().first;
    for (std::size_t i = 1; i < angles.size(); ++i)
        if (const double gap = angles[i].first - angles[i - 1].first; gap > widest) widest = gap, first = i;
    std::vector<Vector2d> sorted;
    for (std::size_t i = 0; i < angles.size(); ++i) sorted.push_back(places[angles[(first + i) % angles.size()].second]);
    return sorted;
}

/// Integrated autocorrelation time: sum of the autocorrelations at positive and negative lags, up to the first pair of
/// consecutive lags whose sum is not positive.
double correlation_time(const std::vector<double>& values) {
    const std::size_t n = values.size();
    const auto product = [&](std::size_t lag) {
        double sum = 0;
        for (std::size_t i = 0; i + lag < n; ++i) sum += values[i] * values[i + lag];
        return sum;
    };
    const double variance = product(0);
    if (!(variance > 0)) return 1;
    double sum = -1;
    for (std::size_t lag = 0; lag + 1 < n; lag += 2) {
        const double pair = (product(lag) + product(lag + 1)) / variance;
        if (!(pair > 0)) break;
        sum += 2 * pair;
    }
    return std::max(1.0, sum);
}

/// Computes the deviation and the confidence interval of the radius from samples.
void judge(ArcFit& fit, const std::vector<Vector2d>& places) {
    const double r = fit.circle.radius;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    std::vector<double> residuals;
    double squares = 0;
    for (const Vector2d& p : in_order(places, fit.circle.centre)) {
        const Vector2d q = p - fit.circle.centre;
        const double d = q.norm();
        if (!(d > 0)) continue;
        const Eigen::Vector3d j(q.x() / d, q.y() / d, 1);
        information += j * j.transpose();
        residuals.push_back(d - r);
        squares += residuals.back() * residuals.back();
    }
    if (residuals.empty()) return;
    const auto count = static_cast<double>(residuals.size());
    fit.deviation = std::sqrt(squares / count);
    fit.independent = count / correlation_time(residuals);
    const double freedom = std::max(1.0, fit.independent - 3);  // at least 1, for strongly correlated residuals
    if (fit.deviation < 1e-12 * r) {                            // residuals due to rounding
        fit.radius_low = fit.radius_high = r;
        return;
    }
    const Eigen::Matrix3d inverse = (information / count).inverse();
    const double variance = squares / count / freedom * inverse(2, 2);
    if (!(std::isfinite(variance) && variance >= 0)) return;
    const double t = boost::math::quantile(boost::math::complement(boost::math::students_t_distribution<double>(freedom), 0.025));
    const double half = t * std::sqrt(variance) / (r * r), curvature = 1 / r;
    fit.radius_low = 1 / (curvature + half);
    if (half < curvature) fit.radius_high = 1 / (curvature - half);
}

/// Gauss-Newton steps of the geometric fit to points.
Circle refined(const std::vector<Vector2d>& points, Circle circle) {
    for (int step = 0; step < 100; ++step) {
        Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        for (const Vector2d& p : points) {
            const Vector2d q = p - circle.centre;
            const double d = q.norm();
            if (!(d > 0)) continue;
            const Eigen::Vector3d j(q.x() / d, q.y() / d, 1);
            H += j * j.transpose(), g += (d - circle.radius) * j;
        }
        const Eigen::Vector3d move = H.inverse() * g;
        if (!move.allFinite() || move.norm() > 1e3 * circle.radius) break;
        circle.centre += move.head<2>(), circle.radius += move[2];
        if (move.norm() < 1e-13 * circle.radius) break;
    }
    return circle;
}

}  // namespace

Circle fit_circle(const std::vector<Vector2d>& points, const std::vector<double>& weights) {
    Vector2d mean = Vector2d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) mean += weights[i] * points[i], total += weights[i];
    if (!(total > 0)) return {};
    mean /= total;
    // q|^2 = 2 c . q + (r^2 - |c|^2), relative to the mean.
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
    // Two nodes per segment integrate the cubic terms of the algebraic fit exactly.
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
        // At a saddle point, the iteration continues in the direction of negative curvature, towards larger coordinates.
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
        if (!(next.square <= fit.square * (1 + 1e-12))) {  // a larger value due to rounding counts as equal
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

double angle_covered(const PlaneSegments& segments, const Vector2d& centre) {
    constexpr double turn = 2 * pi;
    std::vector<std::pair<double, double>> arcs;
    for (const auto& [p, q] : segments) {
        const Vector2d a = p - centre, b = q - centre;
        double from = std::atan2(a.y(), a.x()), to = std::atan2(b.y(), b.x());
        if (from > to) std::swap(from, to);
        if (to - from <= turn / 2) {
            arcs.emplace_back(from, to);
        } else {
            arcs.emplace_back(to, turn / 2);
            arcs.emplace_back(-turn / 2, from);
        }
    }
    std::sort(arcs.begin(), arcs.end());
    double sum = 0, reached = -turn / 2;
    for (const auto& [from, to] : arcs) {
        sum += std::max(0.0, to - std::max(from, reached));
        reached = std::max(reached, to);
    }
    return std::min(sum, turn);
}

double angle_covered(std::vector<double> angles) {
    if (angles.size() < 2) return 0;
    std::sort(angles.begin(), angles.end());
    std::vector<double> gaps{angles.front() + 2 * pi - angles.back()};
    for (std::size_t i = 1; i < angles.size(); ++i) gaps.push_back(angles[i] - angles[i - 1]);
    std::sort(gaps.begin(), gaps.end());
    const std::size_t n = gaps.size();
    const double plain = 5 * degree, common = std::max(plain, 6 * gaps[(n - 1) / 2]);
    double covered = 2 * pi;
    for (std::size_t i = 0; i < n; ++i) {
        const bool widest = i + 1 == n;
        if (gaps[i] > (widest ? std::max(plain, std::min(common, 1.5 * gaps[n - 2])) : common)) covered -= gaps[i];
    }
    return std::max(0.0, covered);
}

bool ArcFit::is_round() const {
    if (!(circle.radius > 0) || deviation > circle.radius / 20) return false;
    const double bulge = circle.radius * (1 - std::cos(std::min(angle / 2, pi / 2)));
    // Residuals with that many independent values are noise, not a systematic shape.
    return deviation <= bulge / 20 || independent >= 20;
}

double ArcFit::uncertainty() const { return (radius_high - radius_low) / 2 / circle.radius; }

std::pair<double, double> ArcFit::angles() const {
    const double low = std::isfinite(radius_high) ? angle * circle.radius / radius_high : 0;
    return {low, radius_low > 0 ? std::min(2 * pi, angle * circle.radius / radius_low) : 2 * pi};
}

ArcFit fit_arc(const PlaneSegments& segments) {
    ArcFit fit;
    fit.circle = fit_circle(segments);
    if (!(fit.circle.radius > 0)) return fit;
    fit.angle = angle_covered(segments, fit.circle.centre);
    double length = 0;
    for (const auto& [a, b] : segments) length += (b - a).norm();
    const double step = length / static_cast<double>(std::clamp<std::size_t>(2 * segments.size(), 200, 2000));
    std::vector<Vector2d> places;
    // One sample in each step, at a varying position: with segments of equal length, a fixed position would always sample the
    // same part of the chord.
    const auto place = [&](double k) { return step * (k + std::fmod(0.5 + k * 0.6180339887498949, 1.0)); };
    double passed = 0, k = 0;
    for (const auto& [a, b] : segments) {
        const double piece = (b - a).norm();
        for (; place(k) < passed + piece; ++k) places.push_back(a + (place(k) - passed) / piece * (b - a));
        passed += piece;
    }
    judge(fit, places);
    return fit;
}

ArcFit fit_arc(const std::vector<Vector2d>& points) {
    ArcFit fit;
    fit.circle = fit_circle(points, std::vector<double>(points.size(), 1));
    if (!(fit.circle.radius > 0)) return fit;
    fit.circle = refined(points, fit.circle);
    judge(fit, points);
    // The gaps between neighbouring points count as covered, except for outlying ones.
    std::vector<double> angles;
    for (const Vector2d& p : points) angles.push_back(std::atan2(p.y() - fit.circle.centre.y(), p.x() - fit.circle.centre.x()));
    fit.angle = angle_covered(std::move(angles));
    return fit;
}

CircleDeviation circle_deviation(const PlaneSegments& segments, const Circle& circle) {
    CircleDeviation deviation;
    double length = 0;
    const auto add = [&](const Vector2d& a, const Vector2d& b) {
        integrate_piece(a, b, circle.centre, [&](const Vector2d& p, double w) {
            const double d = (p - circle.centre).norm();
            // (d^2 - r^2) / (d + r) would not be more precise: d and r are each rounded once.
            const double e = std::abs(d - circle.radius);
            deviation.absolute += w * e, deviation.square += w * e * e, length += w;
        });
    };
    for (const auto& [a, b] : segments) {
        // d - r| has a kink where the segment crosses the circle: the segment is split there.
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
