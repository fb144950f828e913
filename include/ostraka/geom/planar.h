// Convex hulls and rectangles in a plane.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// The corners of the convex hull, counter-clockwise, none between two others on a line (Andrew 1979; exact for the coordinates
/// as given). Fewer than three corners if all points lie on one line.
std::vector<Eigen::Vector2d> convex_hull(const std::vector<Eigen::Vector2d>& points);

/// Signed area (positive counter-clockwise) and the integral of the place over it, both about the first point, of a polygon.
struct PolygonMoments {
    double area = 0;
    Eigen::Vector2d first{0, 0};  ///< integral of (place - reference)
};
PolygonMoments polygon_moments(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& reference);

/// A rectangle in any direction.
struct PlaneRectangle {
    Eigen::Vector2d centre{0, 0};
    Eigen::Vector2d along{1, 0};     ///< unit vector of the long side
    double length = 0, breadth = 0;  ///< length >= breadth >= 0
    [[nodiscard]] double area() const { return length * breadth; }
};

/// The rectangle of least area around a convex polygon (a side of it lies on one of the hull's: rotating calipers, Toussaint
/// 1983); of several whose areas agree to 1e-9 the longest. Of two points or one: without breadth, or extent.
PlaneRectangle smallest_rectangle(const std::vector<Eigen::Vector2d>& hull);

}  // namespace ostraka
