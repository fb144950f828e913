// Convex hulls in a plane and bounding rectangles.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <vector>

namespace ostraka::detail {

/// The corners of the convex hull of points, counter-clockwise (Andrew 1979). `left(a, b, c)`: true if c lies strictly to the
/// left of the line from a to b. PlanarPoint: has the coordinates [0] and [1].
template <class PlanarPoint, class Left>
std::vector<PlanarPoint> convex_hull(std::vector<PlanarPoint> p, Left&& left) {
    std::sort(p.begin(), p.end(),
              [](const PlanarPoint& a, const PlanarPoint& b) { return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]); });
    std::vector<PlanarPoint> hull;
    for (int side = 0; side < 2; ++side) {
        const std::size_t base = hull.size();
        for (const PlanarPoint& q : p) {
            while (hull.size() >= base + 2 && !left(hull[hull.size() - 2], hull.back(), q)) hull.pop_back();
            hull.push_back(q);
        }
        hull.pop_back();
        std::reverse(p.begin(), p.end());
    }
    return hull;
}

/// Limits of a rectangle around a convex polygon, in the coordinates of its axes.
struct Extent {
    double x0, x1, y0, y1;  ///< min and max along the first and along the second axis
};

/// Extent of a polygon along the unit vector `a` and perpendicular to `a`, computed from all corners.
inline Extent extent_along(const Eigen::Vector2d& a, const std::vector<Eigen::Vector2d>& hull) {
    Extent e{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Eigen::Vector2d& q : hull) {
        const double x = a.dot(q), y = a[0] * q[1] - a[1] * q[0];
        e.x0 = std::min(e.x0, x), e.x1 = std::max(e.x1, x), e.y0 = std::min(e.y0, y), e.y1 = std::max(e.y1, y);
    }
    return e;
}

/// Rotating calipers (Toussaint 1983): while a bounding rectangle is aligned with successive sides of a counter-clockwise convex
/// polygon, the polygon corners that touch the rectangle only advance. Three touching corners are tracked; the fourth side of the
/// rectangle lies on the polygon side itself.
class Calipers {
public:
    explicit Calipers(const std::vector<Eigen::Vector2d>& hull) : hull_(hull) {}
    /// Extent of the rectangle aligned with polygon side number `side`, whose unit vector is `a`; sides must be passed in order.
    Extent along(std::size_t side, const Eigen::Vector2d& a) {
        const Eigen::Vector2d b(-a[1], a[0]);
        if (!started_) right_ = top_ = left_ = side;
        right_ = farthest(right_, a);
        top_ = farthest(started_ ? top_ : right_, b);
        left_ = farthest(started_ ? left_ : top_, -a);
        started_ = true;
        return {a.dot(hull_[left_]), a.dot(hull_[right_]), b.dot(hull_[side]), b.dot(hull_[top_])};
    }

private:
    std::size_t farthest(std::size_t from, const Eigen::Vector2d& direction) const {
        for (std::size_t step = 0; step < hull_.size(); ++step) {
            const std::size_t next = (from + 1) % hull_.size();
            if (direction.dot(hull_[next]) < direction.dot(hull_[from])) break;
            from = next;
        }
        return from;
    }

    const std::vector<Eigen::Vector2d>& hull_;
    std::size_t right_ = 0, top_ = 0, left_ = 0;
    bool started_ = false;
};

}  // namespace ostraka::detail
