#include "ostraka/measure/solid.h"

#include "ostraka/core/progress.h"

#include <CGAL/convex_hull_3.h>

#include <cmath>

#include <algorithm>
#include <numeric>

namespace ostraka {

ConvexHullSize convex_hull_size(const std::vector<Point>& points) {
    check_cancelled();
    if (points.size() < 4) return {};
    // Relative to the first point, for precision; a planar hull has no interior.
    std::vector<Point> local_points;
    local_points.reserve(points.size());
    for (const Point& p : points) local_points.push_back(CGAL::ORIGIN + (p - points.front()));
    CGAL::Surface_mesh<Point> hull;
    CGAL::convex_hull_3(local_points.begin(), local_points.end(), hull);
    if (hull.number_of_faces() < 4) return {};
    // The order of the hull's faces and their first corners depend on memory addresses; the order of summation must not.
    std::vector<double> volumes, areas;
    for (const Face face : hull.faces()) {
        const Halfedge start = hull.halfedge(face);
        Halfedge first = start;
        for (Halfedge h = hull.next(start); h != start; h = hull.next(h))
            if (hull.point(hull.target(h)) < hull.point(hull.target(first))) first = h;
        const Vector a = hull.point(hull.target(first)) - CGAL::ORIGIN;
        for (Halfedge h = hull.next(first); hull.next(h) != first; h = hull.next(h)) {
            const Vector b = hull.point(hull.target(h)) - CGAL::ORIGIN, c = hull.point(hull.target(hull.next(h))) - CGAL::ORIGIN;
            volumes.push_back(CGAL::cross_product(a, b) * c / 6);
            areas.push_back(std::sqrt(CGAL::cross_product(b - a, c - a).squared_length()) / 2);
        }
    }
    const auto sum = [](std::vector<double>& parts) {
        std::sort(parts.begin(), parts.end());
        return std::accumulate(parts.begin(), parts.end(), 0.0);
    };
    return {std::abs(sum(volumes)), sum(areas)};
}

}  // namespace ostraka
