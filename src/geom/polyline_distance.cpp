#include "ostraka/geom/polyline_distance.h"

#include "ostraka/geom/watched_tree.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {
using Segment = Kernel::Segment_3;
using Iterator = std::vector<Segment>::const_iterator;
using SegmentTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_segment_primitive<Kernel, Iterator>>>;

double one_sided(const Segments& from, const Segments& to) {
    std::vector<Segment> segments;
    segments.reserve(to.size());
    for (const auto& [p, q] : to) segments.emplace_back(p, q);
    SegmentTree tree(segments.begin(), segments.end());
    build_watched(tree);
    double worst = 0;
    const Point* last = nullptr;
    for (const auto& [p, q] : from) {
        const Point middle = CGAL::midpoint(p, q);
        for (const Point* x : {&p, &middle, &q}) {
            if (last != nullptr && *last == *x) continue;
            last = x == &middle ? nullptr : x;
            worst = std::max(worst, tree.squared_distance(*x));
        }
    }
    return std::sqrt(worst);
}
}  // namespace

double hausdorff_distance(const Segments& a, const Segments& b) {
    if (a.empty() && b.empty()) return 0;
    if (a.empty() || b.empty()) return std::numeric_limits<double>::infinity();
    return std::max(one_sided(a, b), one_sided(b, a));
}

}  // namespace ostraka
