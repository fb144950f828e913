#include "io/soup_geometry.h"

#include "io/triangle_tree.h"
#include "ostraka/execution/parallel.h"

#include <cmath>

namespace ostraka::detail {

bool has_no_area(const TriangleSoup& soup, const std::array<Index, 3>& t) {
    const Point a = point(soup, t[0]), b = point(soup, t[1]), c = point(soup, t[2]);
    const Vector u = b - a, v = c - a;
    const double lengths = u.squared_length() * v.squared_length();
    // Differences of doubles are exact to half a unit in the last place, their product to a few units: values far from zero
    // need no exact arithmetic.
    if (lengths > 1e-200 && lengths < 1e300 && CGAL::cross_product(u, v).squared_length() > 1e-26 * lengths) return false;
    return CGAL::collinear(a, b, c);
}

std::vector<std::uint8_t> triangles_without_area(const TriangleSoup& soup) {
    std::vector<std::uint8_t> none(soup.triangles.size(), 0);
    parallel_for(none.size(), 4096, [&](std::size_t t) { none[t] = has_no_area(soup, soup.triangles[t]) ? 1 : 0; });
    return none;
}

CGAL::Bbox_3 box_of_triangles(const TriangleSoup& soup) {
    CGAL::Bbox_3 box;
    for (const auto& t : soup.triangles)
        for (const Index v : t) box += point(soup, v).bbox();
    return box;
}

double diagonal(const CGAL::Bbox_3& box) {
    if (!(box.xmax() >= box.xmin())) return 0;
    return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

namespace {
/// Parity of the crossings of the segment with each other component; returns false if the segment touches an edge or a vertex.
/// Only the first `max_boxes` intersected boxes of the tree are examined.
bool crossing_parity(const TriangleSoup& soup, const TriangleTree& tree, const std::vector<Index>& component, Index own_component,
                     const Point& from, const Point& to, std::size_t max_boxes, std::vector<std::pair<Index, bool>>& parity) {
    bool clean = true;
    std::vector<Index> hits;
    tree.along_segment(from, to, max_boxes, [&](Index t) {
        if (!clean || component[t] == no_index || component[t] == own_component) return;
        const auto& [a, b, c] = soup.triangles[t];
        const Point p = point(soup, a), q = point(soup, b), r = point(soup, c);
        const auto u = CGAL::orientation(from, to, p, q), v = CGAL::orientation(from, to, q, r),
                   w = CGAL::orientation(from, to, r, p);
        if (u == CGAL::COPLANAR && v == CGAL::COPLANAR && w == CGAL::COPLANAR) return clean = false, void();
        const bool positive = u == CGAL::POSITIVE || v == CGAL::POSITIVE || w == CGAL::POSITIVE;
        const bool negative = u == CGAL::NEGATIVE || v == CGAL::NEGATIVE || w == CGAL::NEGATIVE;
        if (positive && negative) return;
        if (u == CGAL::COPLANAR || v == CGAL::COPLANAR || w == CGAL::COPLANAR) return clean = false, void();
        const auto start = CGAL::orientation(p, q, r, from), end = CGAL::orientation(p, q, r, to);
        if (start == CGAL::COPLANAR || end == CGAL::COPLANAR) return clean = false, void();
        if (start != end) hits.push_back(component[t]);
    });
    std::sort(hits.begin(), hits.end());
    for (std::size_t i = 0; i < hits.size();) {
        std::size_t j = i;
        while (j < hits.size() && hits[j] == hits[i]) ++j;
        parity.emplace_back(hits[i], (j - i) % 2 == 1);
        i = j;
    }
    return clean;
}
}  // namespace

std::vector<std::vector<Index>> enclosing_components(const TriangleSoup& soup, const std::vector<Index>& component_of_triangle,
                                                     const std::vector<bool>& closed, const std::vector<Index>& inner) {
    std::vector<std::vector<Index>> enclosing(closed.size());
    if (inner.empty() || closed.size() < 2) return enclosing;
    std::vector<CGAL::Bbox_3> boxes(closed.size());
    std::vector<Index> first_triangle(closed.size(), no_index);
    for (Index t = 0; t < soup.triangles.size(); ++t) {
        const Index c = component_of_triangle[t];
        if (c == no_index) continue;
        if (first_triangle[c] == no_index) first_triangle[c] = t;
        for (const Index v : soup.triangles[t]) boxes[c] += point(soup, v).bbox();
    }
    const TriangleTree tree(soup);
    // Thousands of nested shells would take quadratic time.
    const std::size_t max_boxes = std::max<std::size_t>(20'000, 200'000'000 / inner.size());
    const double ray_length = 2 * diagonal(box_of_triangles(soup));
    parallel_for(inner.size(), 8, [&](std::size_t i) {
        const Index own_component = inner[i];
        // Triangles of the component itself are ignored, so the ray may start on one of them.
        const auto& t = soup.triangles[first_triangle[own_component]];
        const Point start = CGAL::centroid(point(soup, t[0]), point(soup, t[1]), point(soup, t[2]));
        // Fixed generic directions; if a ray touches an edge, the next direction is used.
        for (int attempt = 0; attempt < 16; ++attempt) {
            const double s = 0.7316 + attempt * 0.3947, z = std::cos(1.13 + attempt * 0.717);
            const double r = std::sqrt(1 - z * z);
            const Point end = start + ray_length * Vector(r * std::cos(s), r * std::sin(s), z);
            std::vector<std::pair<Index, bool>> parity;
            if (!crossing_parity(soup, tree, component_of_triangle, own_component, start, end, max_boxes, parity) && attempt < 15)
                continue;
            for (const auto& [other, is_odd] : parity) {
                if (!is_odd || !closed[other]) continue;
                const auto &a = boxes[own_component], &b = boxes[other];
                if (a.xmin() >= b.xmin() && a.xmax() <= b.xmax() && a.ymin() >= b.ymin() && a.ymax() <= b.ymax() &&
                    a.zmin() >= b.zmin() && a.zmax() <= b.zmax())
                    enclosing[own_component].push_back(other);
            }
            break;
        }
    });
    return enclosing;
}

std::vector<std::uint8_t> enclosed_components(const TriangleSoup& soup, const std::vector<Index>& component_of_triangle,
                                              const std::vector<bool>& closed, const std::vector<Index>& inner) {
    const auto enclosing = enclosing_components(soup, component_of_triangle, closed, inner);
    std::vector<std::uint8_t> enclosed(closed.size(), 0);
    for (std::size_t c = 0; c < closed.size(); ++c) enclosed[c] = enclosing[c].empty() ? 0 : 1;
    return enclosed;
}

}  // namespace ostraka::detail
