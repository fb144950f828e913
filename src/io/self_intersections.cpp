// Self-intersections: candidates from the box tree, decided by exact orientation predicates.
#include "ostraka/core/parallel.h"
#include "ostraka/io/diagnose.h"
#include "soup_edges.h"
#include "soup_geometry.h"
#include "triangle_tree.h"

#include <CGAL/intersections.h>

namespace ostraka {

namespace {

using detail::point;

/// Does segment pq, whose end points lie on the sides `p_side` and `q_side` of the triangle's plane, meet the triangle?
bool segment_meets(const Point& p, const Point& q, CGAL::Orientation p_side, CGAL::Orientation q_side,
                   const std::array<Point, 3>& t) {
    if (p_side == q_side && p_side != CGAL::COPLANAR) return false;
    if (p_side == CGAL::COPLANAR && q_side == CGAL::COPLANAR)
        return CGAL::do_intersect(Kernel::Segment_3(p, q), Kernel::Triangle_3(t[0], t[1], t[2]));
    // The line of the segment meets the plane in one point; that point lies in the triangle if the line passes its three
    // sides on the same hand.
    bool positive = false, negative = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const CGAL::Orientation side = CGAL::orientation(p, q, t[k], t[(k + 1) % 3]);
        positive = positive || side == CGAL::POSITIVE;
        negative = negative || side == CGAL::NEGATIVE;
        if (positive && negative) return false;
    }
    return true;
}

bool on_one_side(const std::array<CGAL::Orientation, 3>& sides) {
    return sides[0] != CGAL::COPLANAR && sides[0] == sides[1] && sides[1] == sides[2];
}

bool disjoint_triangles_meet(const std::array<Point, 3>& s, const std::array<Point, 3>& t) {
    std::array<CGAL::Orientation, 3> s_sides, t_sides;  // of the corners of s relative to the plane of t, and the other way
    for (std::size_t k = 0; k < 3; ++k) s_sides[k] = CGAL::orientation(t[0], t[1], t[2], s[k]);
    if (on_one_side(s_sides)) return false;
    for (std::size_t k = 0; k < 3; ++k) t_sides[k] = CGAL::orientation(s[0], s[1], s[2], t[k]);
    if (on_one_side(t_sides)) return false;
    if (s_sides == std::array{CGAL::COPLANAR, CGAL::COPLANAR, CGAL::COPLANAR})
        return CGAL::do_intersect(Kernel::Triangle_3(s[0], s[1], s[2]), Kernel::Triangle_3(t[0], t[1], t[2]));
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        if (segment_meets(s[k], s[l], s_sides[k], s_sides[l], t) || segment_meets(t[k], t[l], t_sides[k], t_sides[l], s))
            return true;
    }
    return false;
}

/// s[0] and t[0] are the same place. Whatever else the triangles share reaches the opposite side of one of them.
bool triangles_at_vertex_meet(const std::array<Point, 3>& s, const std::array<Point, 3>& t) {
    const CGAL::Orientation s1 = CGAL::orientation(t[0], t[1], t[2], s[1]), s2 = CGAL::orientation(t[0], t[1], t[2], s[2]);
    if (s1 == s2 && s1 != CGAL::COPLANAR) return false;
    const CGAL::Orientation t1 = CGAL::orientation(s[0], s[1], s[2], t[1]), t2 = CGAL::orientation(s[0], s[1], s[2], t[2]);
    if (t1 == t2 && t1 != CGAL::COPLANAR) return false;
    return segment_meets(s[1], s[2], s1, s2, t) || segment_meets(t[1], t[2], t1, t2, s);
}

/// Decides whether two triangles without collinear corners share more than what joins them.
class PairTest {
public:
    PairTest(const TriangleSoup& soup, const std::vector<Index>& place) : soup_(soup), place_(place) {}

    bool operator()(Index first, Index second) const {
        auto s = soup_.triangles[first], t = soup_.triangles[second];
        // Shared places are turned to the front of both.
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
            return CGAL::orientation(a[0], a[1], a[2], b[2]) == CGAL::COPLANAR &&
                   CGAL::coplanar_orientation(a[0], a[1], a[2], b[2]) == CGAL::POSITIVE;
        return shared == 1 ? triangles_at_vertex_meet(a, b) : disjoint_triangles_meet(a, b);
    }

private:
    [[nodiscard]] Point corner(Index v) const { return point(soup_, v); }
    const TriangleSoup& soup_;
    const std::vector<Index>& place_;
};

}  // namespace

SelfIntersections self_intersections(const TriangleSoup& soup, std::size_t limit) {
    return detail::self_intersections(soup, detail::same_place(soup.points), detail::triangles_without_area(soup), limit);
}

SelfIntersections detail::self_intersections(const TriangleSoup& soup, const std::vector<Index>& place,
                                             const std::vector<std::uint8_t>& without_area, std::size_t limit) {
    SelfIntersections result;
    const TriangleTree tree(soup);
    const PairTest meets(soup, place);
    // Fixed batches and fixed budgets: where the search is given up does not depend on the threads.
    constexpr std::size_t batch = 8192, tests_of_leaf = 1 << 17, pairs_of_leaf = 4096;
    const std::size_t max_tests = 400 * soup.triangles.size() + 50'000'000;
    const std::size_t leaves = tree.leaf_count();
    std::vector<std::vector<std::pair<Index, Index>>> found(std::min(batch, leaves));
    std::vector<std::size_t> tested(found.size());
    std::size_t tests = 0;
    for (std::size_t begin = 0; begin < leaves && result.complete; begin += batch) {
        const std::size_t count = std::min(batch, leaves - begin);
        parallel_for(
            count,
            [&](std::size_t i) {
                found[i].clear();
                tested[i] = 0;
                tree.pairs_of_leaf(static_cast<Index>(begin + i), [&](Index a, Index b) {
                    if (without_area[a] != 0 || without_area[b] != 0) return true;
                    if (meets(a, b)) found[i].emplace_back(std::min(a, b), std::max(a, b));
                    return ++tested[i] < tests_of_leaf && found[i].size() < pairs_of_leaf;
                });
            },
            64);
        for (std::size_t i = 0; i < count; ++i) {
            result.pairs.insert(result.pairs.end(), found[i].begin(), found[i].end());
            tests += tested[i];
            result.complete = result.complete && tested[i] < tests_of_leaf && found[i].size() < pairs_of_leaf;
        }
        result.complete = result.complete && result.pairs.size() <= limit && (tests < max_tests || begin + count == leaves);
    }
    std::sort(result.pairs.begin(), result.pairs.end());
    if (result.pairs.size() > limit) result.pairs.resize(limit);
    return result;
}

}  // namespace ostraka
