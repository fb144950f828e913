// Convex hulls and bounding rectangles in a plane.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// The corners of the convex hull, counter-clockwise, without corners on a line between two others (Andrew 1979; exact for the
/// given coordinates). Fewer than three corners if all points are collinear.
std::vector<Eigen::Vector2d> convex_hull(const std::vector<Eigen::Vector2d>& points);

/// Signed area of a polygon (positive if counter-clockwise) and its first moment, both relative to a reference point.
struct PolygonMoments {
    double area = 0;
    Eigen::Vector2d first{0, 0};  ///< integral of (place - reference)
};
PolygonMoments polygon_moments(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& reference);

/// A rectangle of any orientation.
struct PlaneRectangle {
    Eigen::Vector2d centre{0, 0};
    Eigen::Vector2d along{1, 0};     ///< unit vector of the long side
    double length = 0, breadth = 0;  ///< length >= breadth >= 0
    [[nodiscard]] double area() const { return length * breadth; }
};

/// The minimum-area rectangle around a convex polygon (one of its sides lies on a side of the hull: rotating calipers,
/// Toussaint 1983); among rectangles whose areas agree to 1e-9, the longest. For two points the breadth is 0; for one point,
/// the length as well.
PlaneRectangle smallest_rectangle(const std::vector<Eigen::Vector2d>& hull);

}  // namespace ostraka
