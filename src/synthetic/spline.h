// Interpolating cubic splines over chord length, and the search for the point of a spline that minimises a distance.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace ostraka::shapes {

/// Cubic spline through `points` at given knots. `start`, `end`: prescribed slopes; an end without prescribed slope has zero
/// curvature.
template <int D>
class Spline {
public:
    using Vec = Eigen::Matrix<double, D, 1>;
    /// Value, first and second derivative at a parameter.
    struct State {
        Vec value, first, second;
    };

    Spline(std::vector<double> knots, std::vector<Vec> points, std::optional<Vec> start = {}, std::optional<Vec> end = {})
        : knots_(std::move(knots)), points_(std::move(points)), bends_(points_.size(), Vec::Zero()) {
        // Second derivatives at the knots: one tridiagonal system, solved by elimination (de Boor, A Practical Guide to Splines,
        // IV).
        const std::size_t n = points_.size();
        std::vector<double> diagonal(n, 1), above(n, 0), below(n, 0);
        const auto slope = [&](std::size_t i) -> Vec { return (points_[i + 1] - points_[i]) / step(i); };
        for (std::size_t i = 1; i + 1 < n; ++i) {
            below[i] = step(i - 1) / 6;
            diagonal[i] = (step(i - 1) + step(i)) / 3;
            above[i] = step(i) / 6;
            bends_[i] = slope(i) - slope(i - 1);
        }
        if (start) {
            diagonal[0] = step(0) / 3, above[0] = step(0) / 6;
            bends_[0] = slope(0) - *start;
        }
        if (end) {
            diagonal[n - 1] = step(n - 2) / 3, below[n - 1] = step(n - 2) / 6;
            bends_[n - 1] = *end - slope(n - 2);
        }
        for (std::size_t i = 1; i < n; ++i) {
            const double factor = below[i] / diagonal[i - 1];
            diagonal[i] -= factor * above[i - 1];
            bends_[i] -= factor * bends_[i - 1];
        }
        bends_[n - 1] /= diagonal[n - 1];
        for (std::size_t i = n - 1; i-- > 0;) bends_[i] = (bends_[i] - above[i] * bends_[i + 1]) / diagonal[i];
    }

    /// Value and derivatives at a parameter.
    [[nodiscard]] State at(double t) const {
        const auto next = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, t);
        const auto i = static_cast<std::size_t>(next - knots_.begin()) - 1;
        const double h = step(i), a = (knots_[i + 1] - t) / h, b = (t - knots_[i]) / h;
        return {
            a * points_[i] + b * points_[i + 1] + ((a * a * a - a) * bends_[i] + (b * b * b - b) * bends_[i + 1]) * (h * h / 6),
            (points_[i + 1] - points_[i]) / h + ((1 - 3 * a * a) * bends_[i] + (3 * b * b - 1) * bends_[i + 1]) * (h / 6),
            a * bends_[i] + b * bends_[i + 1]};
    }
    [[nodiscard]] double length() const { return knots_.back(); }  ///< last parameter, the chord length of the points

    /// Parameters of samples from start to end, `per_piece` samples in each piece.
    [[nodiscard]] std::vector<double> samples(int per_piece) const {
        std::vector<double> parameters;
        for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
            for (int k = 0; k < per_piece; ++k) parameters.push_back(knots_[i] + step(i) * k / per_piece);
        }
        parameters.push_back(knots_.back());
        return parameters;
    }

private:
    [[nodiscard]] double step(std::size_t i) const { return knots_[i + 1] - knots_[i]; }  ///< length of piece i
    std::vector<double> knots_;                                                           ///< parameter of each point
    std::vector<Vec> points_, bends_;  ///< bends_: second derivatives at the knots
};

/// Root of an increasing function within [low, high] (or the nearest end of the interval), by Newton steps from `t` kept inside a
/// shrinking bracket. `slope_and_bend(t)` returns the function and its derivative.
template <class Function>
double bracketed_root(double low, double high, double t, Function&& slope_and_bend) {
    // The error after a Newton step is of the order of the squared step: smaller steps gain nothing.
    const double tolerance = 1e-7 * (high - low);
    for (int i = 0; i < 40 && high - low > tolerance; ++i) {
        const auto [slope, bend] = slope_and_bend(t);
        (slope > 0 ? high : low) = t;
        const double newton = bend > 0 ? t - slope / bend : high;
        const bool inside = newton >= low && newton <= high && bend > 0;
        const double next = inside ? newton : 0.5 * (low + high);
        const bool converged = inside && std::abs(next - t) <= tolerance;
        t = next;
        if (converged) break;
    }
    return t;
}

/// Samples of a curve grouped by piece, to find the sample of min cost without evaluating all samples.
struct SampleGroups {
    int per_piece;        ///< number of samples per piece
    std::size_t samples;  ///< number of samples: pieces * per_piece + 1
    /// Index of the sample i with the smallest `cost(i)`; `lower_bound(piece)` must not exceed the cost of any sample of the
    /// piece.
    template <class Bound, class Cost>
    [[nodiscard]] std::size_t minimum(Bound&& lower_bound, Cost&& cost) const {
        const std::size_t pieces = samples / static_cast<std::size_t>(per_piece);
        std::size_t best = 0, first_piece = 0;
        double min_bound = std::numeric_limits<double>::infinity(), min_cost = min_bound;
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            const double bound = lower_bound(piece);
            if (bound < min_bound) min_bound = bound, first_piece = piece;
        }
        const auto scan = [&](std::size_t piece) {
            for (std::size_t i = piece * static_cast<std::size_t>(per_piece);
                 i <= (piece + 1) * static_cast<std::size_t>(per_piece); ++i) {
                const double value = cost(i);
                if (value < min_cost) min_cost = value, best = i;
            }
        };
        scan(first_piece);
        for (std::size_t piece = 0; piece < pieces; ++piece) {
            if (piece != first_piece && lower_bound(piece) < min_cost) scan(piece);
        }
        return best;
    }
};

}  // namespace ostraka::shapes
