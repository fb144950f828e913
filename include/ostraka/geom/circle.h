// Circles and curves in a plane: the circle that fits a curve best, and how far the curve strays from a circle.
#pragma once

#include <Eigen/Core>

#include <limits>
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

/// What the pieces cover of the full turn around a place, radians.
double angle_covered(const PlaneSegments& segments, const Eigen::Vector2d& centre);

/// What points at these angles around a place stand for of the full turn, radians: all but the gaps between neighbours that stand
/// out (wider than five degrees and six times the median). The widest is one unless it is below five degrees, or no more than 1.5
/// times as wide as the next and six times the median.
double angle_covered(std::vector<double> angles);

/// A circle and how far the curve it was fitted to tells it. The rest of an open curve is not seen: all that is said holds only
/// if that goes on as the circle does.
struct ArcFit {
    Circle circle;           ///< of least mean squared distance
    double angle = 0;        ///< of the circle's turn that the curve covers, radians
    double deviation = 0;    ///< root mean squared distance from it
    double independent = 0;  ///< about so many of the distances from it tell something of their own
    /// 95 % interval of the radius: infinite above where a straight line fits too, 0 to infinity where too little is there to
    /// tell.
    double radius_low = 0, radius_high = std::numeric_limits<double>::infinity();

    /// The curve is one of a circle, as far as it goes: its distances from it are at most a twentieth of the radius, and of how
    /// far the curve bulges over its chord (1 - cos of half its angle, in radii), or they are noise.
    [[nodiscard]] bool is_round() const;
    /// Half of the interval of the radius, in radii.
    [[nodiscard]] double uncertainty() const;
    /// 95 % interval of the angle.
    [[nodiscard]] std::pair<double, double> angles() const;
};

/// The circle that fits the pieces best, with what its residuals say of its radius: the curvature k = 1 / r has the standard
/// error s / (r^2 sqrt(n)) * sqrt((M^-1)_rr), M the mean of j j^T over places evenly along the pieces, j = (direction from the
/// centre, 1) the derivative of the residual, s^2 the mean squared residual, n the number of residuals that are independent: that
/// of the places over their correlation time (initial positive sequence; Geyer 1992). With Student's t of n - 3 degrees of
/// freedom k's interval is symmetric; the radius' is its inverse. For an arc of length L with noise s this is
/// s sqrt(720 / n) / L^2 (the second derivative of a parabola), so that the relative error of the radius grows as the square of
/// the inverse of the angle. No circle: radius -1.
ArcFit fit_arc(const PlaneSegments& segments);
/// The same for points in any order.
ArcFit fit_arc(const std::vector<Eigen::Vector2d>& points);

/// Mean over the length of |distance from the circle| and of its square; 0 without length. Gauss quadrature with 3 points where a
/// piece is short against its distance from the centre, with 8 elsewhere, longer ones halved until they are not, and cut where
/// they cross the circle: errors near 1e-12 of the radius.
struct CircleDeviation {
    double absolute = 0, square = 0;
};
CircleDeviation circle_deviation(const PlaneSegments& segments, const Circle& circle);

}  // namespace ostraka
