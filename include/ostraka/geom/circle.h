// Fits circles to curves in a plane by least squares, and measures the deviation of a curve from a circle.
#pragma once

#include <Eigen/Core>

#include <limits>
#include <utility>
#include <vector>

namespace ostraka {

/// A circle in a plane.
struct Circle {
    Eigen::Vector2d centre{0, 0};
    double radius = -1;  ///< negative: there is no circle (collinear or empty input)
};

/// Circle with minimum algebraic error (Kasa 1976) of weighted points.
Circle fit_circle(const std::vector<Eigen::Vector2d>& points, const std::vector<double>& weights);

/// Straight segments of curves in a plane.
using PlaneSegments = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

/// Circle with minimum mean squared distance (geometric fit) to the segments. The mean is an integral along the segments, not a
/// sum over end points, so that splitting a segment does not change the circle. The method is a damped Newton iteration that
/// starts from the algebraic fit.
Circle fit_circle(const PlaneSegments& segments);

/// Angle, in radians, that the segments cover as seen from `centre`.
double angle_covered(const PlaneSegments& segments, const Eigen::Vector2d& centre);

/// Angle, in radians, that is covered by samples at the directions `angles` (radians) around a point: the full turn minus the
/// outlying gaps between adjacent samples. A gap is outlying if it is wider than five degrees and wider than six times the
/// median gap. The widest gap is also outlying if it is wider than five degrees and wider than 1.5 times the second widest gap.
double angle_covered(std::vector<double> angles);

/// A circle fitted to a curve, with the confidence interval of its radius. An open curve is assumed to continue along the
/// circle.
struct ArcFit {
    Circle circle;           ///< circle with minimum mean squared distance from the curve
    double angle = 0;        ///< angle of the circle that the curve covers, in radians
    double deviation = 0;    ///< root mean squared distance of the curve from the circle
    double independent = 0;  ///< estimated number of independent residuals (distances from the circle)
    /// 95 % confidence interval of the radius: the upper bound is infinite if a straight line fits equally well; the interval
    /// is 0 to infinity if there are too few data.
    double radius_low = 0, radius_high = std::numeric_limits<double>::infinity();

    /// True if the curve is an arc of a circle: the deviation is at most a twentieth of the radius, and is either noise or at
    /// most a twentieth of the height of the arc over its chord, radius * (1 - cos(angle / 2)).
    [[nodiscard]] bool is_round() const;
    /// Half the width of the radius interval divided by the radius.
    [[nodiscard]] double uncertainty() const;
    /// 95 % confidence interval of `angle`, in radians.
    [[nodiscard]] std::pair<double, double> angles() const;
};

/// The least-squares circle of the segments, with the uncertainty of its radius estimated from the residuals. The curvature k = 1
/// / r has the standard error s / (r^2 sqrt(n)) * sqrt((M^-1)_rr). M is the mean of j j^T over samples spaced evenly along the
/// segments, j = (direction from the centre, 1) is the derivative of the residual, s^2 is the mean squared residual, and n is the
/// number of independent residuals: the number of samples divided by their correlation time (initial positive sequence; Geyer
/// 1992). With Student's t of n - 3 degrees of freedom, the interval of k is symmetric; the interval of the radius is its
/// inverse. For an arc of length L with noise s, the standard error is s sqrt(720 / n) / L^2 (the second derivative of a
/// parabola), so that the relative error of the radius is inversely proportional to the square of the angle. The radius is -1
/// if there is no circle.
ArcFit fit_arc(const PlaneSegments& segments);
/// The least-squares circle of points in any order, with the uncertainty of its radius estimated from the residuals.
ArcFit fit_arc(const std::vector<Eigen::Vector2d>& points);

/// Mean deviation of segments from a circle, averaged along the segments; 0 if the segments have no length. The integral is
/// computed by Gauss quadrature, with 3 nodes for segments that are short compared to their distance from the centre and with 8
/// nodes otherwise. Longer segments are halved until they are short enough, and split where they cross the circle. The error is
/// about 1e-12 of the radius.
struct CircleDeviation {
    double absolute = 0, square = 0;  ///< mean distance from the circle; mean squared distance
};
/// Mean deviation of segments from a circle.
CircleDeviation circle_deviation(const PlaneSegments& segments, const Circle& circle);

}  // namespace ostraka
