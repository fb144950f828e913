// Circles and curves in a plane: the circle that fits a curve best, and how far the curve strays from a circle.
#pragma once

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace ostraka {

/// The radius is negative if there is none (all on one line, nothing given).
struct Circle {
    Eigen::Vector2d centre{0, 0};
    double radius = -1;
};

/// Circle of least algebraic error (Kasa 1976) through weighted points.
Circle fit_circle(const std::vector<Eigen::Vector2d>& points, const std::vector<double>& weights);

/// Straight pieces of curves in a plane.
using PlaneSegments = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

/// Circle of least mean squared distance (geometric fit) along the pieces: integrals along them, not sums over their ends, so
/// that cutting pieces in two changes nothing. Damped Newton steps from the algebraic fit.
Circle fit_circle(const PlaneSegments& segments);

/// Mean over the length of |distance from the circle| and of its square; 0 without length. Gauss quadrature with 3 points where a
/// piece is short against its distance from the centre, with 8 elsewhere, longer ones halved until they are not, and cut where
/// they cross the circle: errors near 1e-12 of the radius.
struct CircleDeviation {
    double absolute = 0, square = 0;
};
CircleDeviation circle_deviation(const PlaneSegments& segments, const Circle& circle);

}  // namespace ostraka
