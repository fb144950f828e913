// Self-intersections: candidates from the tree of bounding boxes, decided by exact orientation predicates. The triangles around
// a vertex of very high valence all touch: among these, only pairs whose directions from the vertex overlap are candidates.
#include "io/soup_edges.h"
#include "io/soup_geometry.h"
#include "io/triangle_tree.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/io/diagnose.h"

#include <CGAL/intersections.h>

#include <cmath>

namespace ostraka {

namespace {

using detail::point;

/// Exact orientation of d relative to the plane of a, b and c; `exact` counts the cases that need exact arithmetic.
CGAL::Orientation side_of(const Point& a, const Point& b, const Point& c, const Point& d, std::size_t& exact) {
    const double ux = b.x() - a.x(), uy = b.y() - a.y(), uz = b.z() - a.z(), vx = c.x() - a.x(), vy = c.y() - a.y(),
                 vz = c.z() - a.z(), wx = d.x() - a.x(), wy = d.y() - a.y(), wz = d.z() - a.z();
    // The difference of equal numbers is exactly 0.
    if ((ux == 0 && vx == 0 && wx == 0) || (uy == 0 && vy == 0 && wy == 0) || (uz == 0 && vz == 0 && wz == 0))
        return CGAL::COPLANAR;
    const double p = vy * wz, q = vz * wy, r = vz * wx, s = vx * wz, t = vx * wy, u = vy * wx;
    const double value = ux * (p - q) + uy * (r - s) + uz * (t - u);
    const double size = std::fabs(ux) * (std::fabs(p) + std::fabs(q)) + std::fabs(uy) * (std::fabs(r) + std::fabs(s)) +
                        std::fabs(uz) * (std::fabs(t) + std::fabs(u));
    // Shewchuk 1997: the error is below (7 + 56 e) e times the sum of the magnitudes, e = 2^-53, unless there is underflow.
    if (size > 1e-250 && std::fabs(value) > 1e-15 * size) return value > 0 ? CGAL::POSITIVE : CGAL::NEGATIVE;
    ++exact;
    return CGAL::orientation(a, b, c, d);
}

/// Whether segment pq, whose end points lie on the sides `p_side` and `q_side` of the triangle's plane, intersects the
/// triangle.
bool segment_meets(const Point& p, const Point& q, CGAL::Orientation p_side, CGAL::Orientation q_side,
                   const std::array<Point, 3>& t, std::size_t& exact) {
    if (p_side == q_side && p_side != CGAL::COPLANAR) return false;
    if (p_side == CGAL::COPLANAR && q_side == CGAL::COPLANAR) {
        exact += 4;
        return CGAL::do_intersect(Kernel::Segment_3(p, q), Kernel::Triangle_3(t[0], t[1], t[2]));
    }
    // The line of the segment intersects the plane in one point, which lies in the triangle if the line passes the three sides
    // with the same orientation.
    bool positive = false, negative = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const CGAL::Orientation side = side_of(p, q, t[k], t[(k + 1) % 3], exact);
        positive = positive || side == CGAL::POSITIVE;
        negative = negative || side == CGAL::NEGATIVE;
        if (positive && negative) return false;
    }
    return true;
}

bool on_one_side(const std::array<CGAL::Orientation, 3>& sides) {
    return sides[0] != CGAL::COPLANAR && sides[0] == sides[1] && sides[1] == sides[2];
}

bool disjoint_triangles_meet(const std::array<Point, 3>& s, const std::array<Point, 3>& t, std::size_t& exact) {
    std::array<CGAL::Orientation, 3> s_sides, t_sides;  // orientation of the corners of s relative
                                                        // to the plane of t, and vice versa
    for (std::size_t k = 0; k < 3; ++k) s_sides[k] = side_of(t[0], t[1], t[2], s[k], exact);
    if (on_one_side(s_sides)) return false;
    for (std::size_t k = 0; k < 3; ++k) t_sides[k] = side_of(s[0], s[1], s[2], t[k], exact);
    if (on_one_side(t_sides)) return false;
    if (s_sides == std::array{CGAL::COPLANAR, CGAL::COPLANAR, CGAL::COPLANAR}) {
        exact += 8;
        return CGAL::do_intersect(Kernel::Triangle_3(s[0], s[1], s[2]), Kernel::Triangle_3(t[0], t[1], t[2]));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        if (segment_meets(s[k], s[l], s_sides[k], s_sides[l], t, exact) ||
            segment_meets(t[k], t[l], t_sides[k], t_sides[l], s, exact))
            return true;
    }
    return false;
}

/// s[0] and t[0] coincide. Any further intersection of the triangles reaches the opposite side of one of them.
bool triangles_at_vertex_meet(const std::array<Point, 3>& s, const std::array<Point, 3>& t, std::size_t& exact) {
    const CGAL::Orientation s1 = side_of(t[0], t[1], t[2], s[1], exact), s2 = side_of(t[0], t[1], t[2], s[2], exact);
    if (s1 == s2 && s1 != CGAL::COPLANAR) return false;
    const CGAL::Orientation t1 = side_of(s[0], s[1], s[2], t[1], exact), t2 = side_of(s[0], s[1], s[2], t[2], exact);
    if (t1 == t2 && t1 != CGAL::COPLANAR) return false;
    return segment_meets(s[1], s[2], s1, s2, t, exact) || segment_meets(t[1], t[2], t1, t2, s, exact);
}

/// Decides whether the intersection of two non-degenerate triangles exceeds their common vertices and edges.
class PairTest {
public:
    PairTest(const TriangleSoup& soup, const std::vector<Index>& place) : soup_(soup), place_(place) {}

    /// `exact` counts the predicates that needed exact arithmetic.
    bool operator()(Index first, Index second, std::size_t& exact) const {
        auto s = soup_.triangles[first], t = soup_.triangles[second];
        // Rotates shared positions to the front of both triangles.
        int shared = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = static_cast<std::size_t>(shared); j < 3; ++j)
                if (i >= static_cast<std::size_t>(shared) && place_[s[i]] == place_[t[j]]) {
                    std::swap(s[i], s[static_cast<std::size_t>(shared)]);
                    std::swap(t[j], t[static_cast<std::size_t>(shared)]);
                    ++shared;
                    break;
                }
        if (shared == 3) return true;
        const std::array<Point, 3> a{corner(s[0]), corner(s[1]), corner(s[2])}, b{corner(t[0]), corner(t[1]), corner(t[2])};
        if (shared == 2)
            return side_of(a[0], a[1], a[2], b[2], exact) == CGAL::COPLANAR &&
                   CGAL::coplanar_orientation(a[0], a[1], a[2], b[2]) == CGAL::POSITIVE;
        return shared == 1 ? triangles_at_vertex_meet(a, b, exact) : disjoint_triangles_meet(a, b, exact);
    }

private:
    [[nodiscard]] Point corner(Index v) const { return point(soup_, v); }
    const TriangleSoup& soup_;
    const std::vector<Index>& place_;
};

/// Positions with more triangles than this are hubs.
constexpr std::size_t many_triangles = 256;

/// For each triangle, 1 + the position of the corner with the most triangles if that is a hub, else 0; degenerate triangles are
/// excluded from the tree.
std::vector<Index> hubs_of(const TriangleSoup& soup, const std::vector<Index>& place,
                           const std::vector<std::uint8_t>& without_area) {
    std::vector<Index> count(soup.points.size(), 0), hubs(soup.triangles.size(), detail::TriangleTree::left_out);
    for (std::size_t t = 0; t < hubs.size(); ++t)
        if (without_area[t] == 0)
            for (const Index v : soup.triangles[t]) ++count[place[v]];
    for (std::size_t t = 0; t < hubs.size(); ++t) {
        if (without_area[t] != 0) continue;
        Index best = place[soup.triangles[t][0]];
        for (const Index v : soup.triangles[t])
            if (count[place[v]] > count[best]) best = place[v];
        hubs[t] = count[best] > many_triangles ? best + 1 : 0;
    }
    return hubs;
}

/// Adds a triangle whose bounding box contains the directions from `hub` to the opposite side of a triangle, on the unit
/// sphere.
void add_directions(const TriangleSoup& soup, const std::vector<Index>& place, Index hub, Index triangle, TriangleSoup& arcs) {
    std::array<std::array<double, 3>, 2> ends{};
    std::size_t end = 0;
    for (const Index v : soup.triangles[triangle]) {
        if (place[v] == hub || end == 2) continue;
        Vector d = point(soup, v) - point(soup, hub);
        const double largest = std::max({std::fabs(d.x()), std::fabs(d.y()), std::fabs(d.z())});
        d = d / largest;
        d = d / std::sqrt(d.squared_length());
        ends[end++] = {d.x(), d.y(), d.z()};
    }
    double squared_half = 0;  // half of the chord, squared
    for (std::size_t k = 0; k < 3; ++k) squared_half += (ends[1][k] - ends[0][k]) * (ends[1][k] - ends[0][k]) / 4;
    const double margin = squared_half / (1 + std::sqrt(std::max(0.0, 1 - squared_half))) + 1e-9;  // height of the arc over its
                                                                                                   // chord, plus rounding errors
    std::array<double, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(ends[0][k], ends[1][k]) - margin;
        high[k] = std::max(ends[0][k], ends[1][k]) + margin;
    }
    const auto first = static_cast<Index>(arcs.points.size());
    arcs.points.insert(arcs.points.end(), {low, high});
    arcs.triangles.push_back({first, first + 1, first + 1});
}

/// Tests the candidate pairs of a tree, within limits that do not depend on the threads.
class BoundedSearch {
public:
    BoundedSearch(const TriangleSoup& soup, const std::vector<Index>& place, std::size_t limit)
        : meets_(soup, place), limit_(limit), max_work_(200 * soup.triangles.size() + 100'000'000) {}

    /// `triangle`: maps triangles of the tree to triangles of the soup; empty: identical.
    void search(const detail::TriangleTree& tree, const std::vector<Index>& triangle) {
        const std::size_t leaves = tree.leaf_count();
        for (std::size_t begin = 0; begin < leaves && result.complete;) {
            // The maximum work of a batch is about the remaining budget.
            const std::size_t max_leaves =
                std::min((max_work_ - std::min(work_, max_work_)) / work_of_leaf, (limit_ - result.pairs.size()) / pairs_of_leaf);
            const std::size_t count = std::min(std::clamp<std::size_t>(max_leaves, 64, 8192), leaves - begin);
            search_leaves(tree, triangle, begin, count);
            begin += count;
            result.complete = result.complete && result.pairs.size() <= limit_ && (work_ < max_work_ || begin == leaves);
        }
    }

    SelfIntersections result;

private:
    // A unit of work is a floating-point test, some hundred nanoseconds.
    static constexpr std::size_t work_of_leaf = 1 << 18, pairs_of_leaf = 4096, boxes_of_test = 16, tests_of_exact = 16;

    struct Leaf {
        std::vector<std::pair<Index, Index>> pairs;
        std::size_t work = 0;
    };

    void search_leaf(const detail::TriangleTree& tree, const std::vector<Index>& triangle, Index number, Leaf& leaf) const {
        leaf.pairs.clear();
        leaf.work = 0;
        std::size_t exact = 0;
        const std::size_t boxes = tree.pairs_of_leaf(number, boxes_of_test * work_of_leaf, [&](Index a, Index b) {
            if (!triangle.empty()) a = triangle[a], b = triangle[b];
            if (meets_(a, b, exact)) leaf.pairs.emplace_back(std::min(a, b), std::max(a, b));
            return ++leaf.work + tests_of_exact * exact < work_of_leaf && leaf.pairs.size() < pairs_of_leaf;
        });
        leaf.work += tests_of_exact * exact + boxes / boxes_of_test;
    }

    void search_leaves(const detail::TriangleTree& tree, const std::vector<Index>& triangle, std::size_t begin,
                       std::size_t count) {
        leaves_.resize(std::max(leaves_.size(), count));
        parallel_for(count, 16, [&](std::size_t i) { search_leaf(tree, triangle, static_cast<Index>(begin + i), leaves_[i]); });
        for (std::size_t i = 0; i < count; ++i) {
            const Leaf& leaf = leaves_[i];
            result.pairs.insert(result.pairs.end(), leaf.pairs.begin(), leaf.pairs.end());
            work_ += leaf.work;
            result.complete = result.complete && leaf.work < work_of_leaf && leaf.pairs.size() < pairs_of_leaf;
        }
    }

    PairTest meets_;
    std::size_t limit_, max_work_, work_ = 0;
    std::vector<Leaf> leaves_;
};

/// Pairs of triangles at the same hub, for each hub.
void search_hubs(const TriangleSoup& soup, const std::vector<Index>& place, const std::vector<Index>& hubs,
                 BoundedSearch& search) {
    std::vector<Index> at_hubs;
    for (Index t = 0; t < hubs.size(); ++t)
        if (hubs[t] != 0 && hubs[t] != detail::TriangleTree::left_out) at_hubs.push_back(t);
    std::stable_sort(at_hubs.begin(), at_hubs.end(), [&](Index a, Index b) { return hubs[a] < hubs[b]; });
    for (std::size_t i = 0; i < at_hubs.size() && search.result.complete;) {
        const Index hub = hubs[at_hubs[i]] - 1;
        TriangleSoup arcs;
        std::vector<Index> triangle;
        for (; i < at_hubs.size() && hubs[at_hubs[i]] == hub + 1; ++i) {
            add_directions(soup, place, hub, at_hubs[i], arcs);
            triangle.push_back(at_hubs[i]);
        }
        search.search(detail::TriangleTree(arcs), triangle);
    }
}

}  // namespace

SelfIntersections self_intersections(const TriangleSoup& soup, std::size_t limit) {
    return detail::self_intersections(soup, detail::same_place(soup.points), detail::triangles_without_area(soup), limit);
}

SelfIntersections detail::self_intersections(const TriangleSoup& soup, const std::vector<Index>& place,
                                             const std::vector<std::uint8_t>& without_area, std::size_t limit) {
    const std::vector<Index> hubs = hubs_of(soup, place, without_area);
    BoundedSearch search(soup, place, limit);
    search.search(TriangleTree(soup, hubs), {});
    search_hubs(soup, place, hubs, search);
    SelfIntersections result = std::move(search.result);
    std::sort(result.pairs.begin(), result.pairs.end());
    if (result.pairs.size() > limit) result.pairs.resize(limit);
    return result;
}

}  // namespace ostraka
