#include "cage/triangle_grid.h"

#include <CGAL/Kernel/global_functions.h>
#include <CGAL/intersections.h>

namespace ostraka::cage {

namespace {

using Segment = Kernel::Segment_3;
using Triangle3 = Kernel::Triangle_3;

/// Two triangles that share the edge pq overlap if they are coplanar and on the same side of it.
bool fold(const Point& p, const Point& q, const Point& r, const Point& s) {
    return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) != CGAL::NEGATIVE;
}

}  // namespace

bool overlap(const Triangle& s, const std::array<Point, 3>& points_s, const Triangle& t, const std::array<Point, 3>& points_t) {
    std::array<int, 3> partner{-1, -1, -1};  // partner[i]: corner of t that equals corner i of s, or -1
    int shared = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (s[i] == t[j]) partner[i] = static_cast<int>(j), ++shared;
    if (shared == 3) return true;
    if (shared == 0)
        return CGAL::do_intersect(Triangle3(points_s[0], points_s[1], points_s[2]),
                                  Triangle3(points_t[0], points_t[1], points_t[2]));
    if (shared == 2) {
        const std::size_t free_corner = partner[0] < 0 ? 0 : partner[1] < 0 ? 1 : 2;
        const auto other = static_cast<std::size_t>(3 - partner[(free_corner + 1) % 3] - partner[(free_corner + 2) % 3]);
        return fold(points_s[(free_corner + 1) % 3], points_s[(free_corner + 2) % 3], points_s[free_corner], points_t[other]);
    }
    // If two triangles with one common corner intersect elsewhere, the intersection reaches the opposite side of one of them.
    const std::size_t i = partner[0] >= 0 ? 0 : partner[1] >= 0 ? 1 : 2;
    const auto j = static_cast<std::size_t>(partner[i]);
    return CGAL::do_intersect(Segment(points_s[(i + 1) % 3], points_s[(i + 2) % 3]),
                              Triangle3(points_t[0], points_t[1], points_t[2])) ||
           CGAL::do_intersect(Segment(points_t[(j + 1) % 3], points_t[(j + 2) % 3]),
                              Triangle3(points_s[0], points_s[1], points_s[2]));
}

}  // namespace ostraka::cage
