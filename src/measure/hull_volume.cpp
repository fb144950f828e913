#include "ostraka/measure/solid.h"

#include <CGAL/convex_hull_3.h>

#include <cmath>

namespace ostraka {

double hull_volume(const std::vector<Point>& points) {
    if (points.size() < 4) return 0;
    // Near the origin, so that nothing is lost; a plane hull has no inside.
    std::vector<Point> near;
    near.reserve(points.size());
    for (const Point& p : points) near.push_back(CGAL::ORIGIN + (p - points.front()));
    CGAL::Surface_mesh<Point> hull;
    CGAL::convex_hull_3(near.begin(), near.end(), hull);
    if (hull.number_of_faces() < 4) return 0;
    double sum = 0;
    for (const Face face : hull.faces()) {
        const Halfedge first = hull.halfedge(face);
        const Point& a = hull.point(hull.target(first));
        for (Halfedge h = hull.next(first); hull.next(h) != first; h = hull.next(h))
            sum += CGAL::cross_product(a - CGAL::ORIGIN, hull.point(hull.target(h)) - CGAL::ORIGIN) *
                   (hull.point(hull.target(hull.next(h))) - CGAL::ORIGIN) / 6;
    }
    return std::abs(sum);
}

}  // namespace ostraka
