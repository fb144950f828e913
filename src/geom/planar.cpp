// Minimum-area rectangle around a convex polygon.
#include "ostraka/geom/planar.h"

#include "geom/calipers.h"

#include "ostraka/mesh/mesh.h"

namespace ostraka {

using namespace detail;

std::vector<Vector2d> convex_hull(const std::vector<Vector2d>& points) {
    if (points.size() < 2) return points;
    auto hull = detail::convex_hull(points, [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
        return CGAL::orientation(Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()), Kernel::Point_2(c.x(), c.y())) ==
               CGAL::LEFT_TURN;
    });
    if (hull.size() == 2 && hull[0] == hull[1]) hull.pop_back();
    return hull;
}

PolygonMoments polygon_moments(const std::vector<Vector2d>& polygon, const Vector2d& reference) {
    PolygonMoments moments;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vector2d a = polygon[i] - reference, b = polygon[(i + 1) % polygon.size()] - reference;
        const double cross = a.x() * b.y() - a.y() * b.x();
        moments.area += cross / 2;
        moments.first += cross / 6 * (a + b);
    }
    return moments;
}

PlaneRectangle smallest_rectangle(const std::vector<Vector2d>& hull) {
    PlaneRectangle best;
    if (hull.empty()) return best;
    best.centre = hull[0];
    if (hull.size() == 1) return best;
    const Vector2d& reference = hull[0];
    std::vector<Vector2d> corners;
    for (const auto& p : hull) corners.push_back(p - reference);
    const auto rectangle = [&](const Vector2d& a, const Extent& e) {
        const Vector2d b(-a.y(), a.x());
        const double x = e.x1 - e.x0, y = e.y1 - e.y0;
        PlaneRectangle r{reference + (e.x0 + e.x1) / 2 * a + (e.y0 + e.y1) / 2 * b, a, x, y};
        if (y > x) r.along = b, std::swap(r.length, r.breadth);
        return r;
    };
    const auto choose = [&](auto&& extent) {
        std::vector<PlaneRectangle> all;
        double minimum = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vector2d side = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
            all.push_back(rectangle(side, extent(i, side)));
            minimum = std::min(minimum, all.back().area());
        }
        best.length = -1;
        for (const auto& r : all)
            if (r.area() <= minimum * (1 + 1e-9) && r.length > best.length) best = r;
    };
    Calipers calipers(corners);
    choose([&](std::size_t i, const Vector2d& side) { return calipers.along(i, side); });
    // Very short sides have arbitrary directions, with which the calipers may fail; then all corners are tested.
    if (const auto check = rectangle(best.along, extent_along(best.along, corners));
        !(std::abs(check.area() - best.area()) <= 1e-12 * check.area()))
        choose([&](std::size_t, const Vector2d& side) { return extent_along(side, corners); });
    return best;
}

}  // namespace ostraka
