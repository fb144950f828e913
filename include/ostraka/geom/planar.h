// Convex hulls and bounding rectangles in a plane.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// The corners of the convex hull, counter-clockwise, without points on a side between two corners (Andrew 1979; exact for the
/// given coordinates). There are fewer than three corners if all points are collinear.
std::vector<Eigen::Vector2d> convex_hull(const std::vector<Eigen::Vector2d>& points);

/// Area and first moment of a polygon.
struct PolygonMoments {
    double area = 0;              ///< signed area: positive if counter-clockwise
    Eigen::Vector2d first{0, 0};  ///< integral of (position - reference) over the polygon
};
/// Area and first moment of a polygon relative to `reference`.
PolygonMoments polygon_moments(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& reference);

/// A rectangle of any orientation.
struct PlaneRectangle {
    Eigen::Vector2d centre{0, 0};    ///< centre of the rectangle
    Eigen::Vector2d along{1, 0};     ///< unit vector of the long side
    double length = 0, breadth = 0;  ///< lengths of the sides, length >= breadth >= 0
    [[nodiscard]] double area() const { return length * breadth; }
};

/// The minimum-area rectangle around a convex polygon (rotating calipers, Toussaint 1983); among rectangles whose areas agree to
/// 1e-9 (relative), the longest rectangle. For two points the breadth is 0; for one point both breadth and length are 0.
PlaneRectangle smallest_rectangle(const std::vector<Eigen::Vector2d>& hull);

}  // namespace ostraka
