// Fills holes with triangles between their border vertices.
#include "io/repair_steps.h"
#include "io/soup_geometry.h"
#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"

#include <cmath>
#include <limits>
#include <queue>
#include <unordered_set>

namespace ostraka::detail {

namespace {

/// The border of one hole: halfedges of the adjacent triangles in the direction of these triangles, that is, clockwise seen
/// from outside. Each ends at the position, but not necessarily at the vertex, where the next one begins.
using Hole = std::vector<Index>;

std::vector<Hole> find_holes(const TriangleSoup& soup, const std::vector<Index>& opposite, const std::vector<Index>& place) {
    std::vector<Index> leaving(soup.points.size(), no_index);  // one border halfedge leaves a border vertex
    for (Index h = 0; h < opposite.size(); ++h)
        if (opposite[h] == no_index) leaving[origin(soup, h)] = h;
    std::vector<std::uint8_t> used(opposite.size(), 0), on_walk(soup.points.size(), 0);
    std::vector<Hole> holes;
    for (Index start = 0; start < opposite.size(); ++start) {
        if (opposite[start] != no_index || used[start] != 0) continue;
        // A walk that returns to a position (touching holes, whose common vertex was split) has completed the loop around a
        // hole.
        Hole walk;
        for (Index h = start; used[h] == 0; h = leaving[target(soup, h)]) {
            used[h] = 1;
            on_walk[place[origin(soup, h)]] = 1;
            walk.push_back(h);
            const Index at = place[target(soup, h)];
            if (on_walk[at] == 0) continue;
            auto first = walk.end() - 1;
            while (place[origin(soup, *first)] != at) --first;
            for (auto i = first; i != walk.end(); ++i) on_walk[place[origin(soup, *i)]] = 0;
            holes.emplace_back(first, walk.end());
            walk.erase(first, walk.end());
        }
    }
    return holes;
}

using Triple = std::array<Index, 3>;  ///< positions along the hole, increasing

/// Triangulates the polygon of the hole without new vertices; empty if that is impossible. A long border is first shortened by
/// cutting off corners, shortest chord first (O(n log n)); the rest is triangulated so that the largest dihedral angle, then
/// the area, is minimal (O(n^3), Liepa 2003, section 3, after Barequet and Sharir 1995).
class HoleFiller {
public:
    HoleFiller(const TriangleSoup& soup, const std::vector<Index>& opposite, const Hole& hole) : soup_(soup), hole_(hole) {
        const auto n = static_cast<Index>(hole.size());
        // Chords along existing edges would make these edges non-manifold.
        std::vector<std::pair<Index, Index>> positions;  // vertex, position
        for (Index i = 0; i < n; ++i) positions.emplace_back(origin(soup, hole[i]), i);
        std::sort(positions.begin(), positions.end());
        for (Index i = 0; i < n; ++i)
            for (Index h = hole[i];;) {  // the fan at position i, starting at the border
                const Index other = origin(soup, previous_halfedge(h));
                const auto match = std::lower_bound(positions.begin(), positions.end(), std::pair<Index, Index>{other, 0});
                if (match != positions.end() && match->first == other) edges_.insert(key(i, match->second));
                h = opposite[previous_halfedge(h)];
                if (h == no_index) break;
            }
        for (Index i = 0; i < n; ++i) {
            edges_.insert(key(i, (i + 1) % n));
            places_.push_back(point(soup, origin(soup, hole[i])));
            outside_.push_back(unit(normal(soup, soup.triangles[hole[i] / 3])));
        }
    }

    std::vector<Triple> run() {
        const auto n = static_cast<Index>(hole_.size());
        if (n < 3 || (n == 3 && hole_[0] / 3 == hole_[1] / 3)) return {};  // a single triangle has no hole
        std::vector<Triple> triangles;
        std::vector<Index> ring(n);
        for (Index i = 0; i < n; ++i) ring[i] = i;
        constexpr std::size_t maximum = 1100;  // 190 million steps and 58 MB at most
        if (n > maximum && !cut_corners(ring, maximum, triangles)) return {};
        if (!best_triangulation(ring, triangles)) return {};
        return triangles;
    }

private:
    static std::uint64_t key(Index i, Index j) { return static_cast<std::uint64_t>(std::min(i, j)) << 32 | std::max(i, j); }
    static Vector unit(const Vector& v) {
        const double length = std::sqrt(v.squared_length());
        return length > 0 ? v / length : Vector(0, 0, 0);
    }
    [[nodiscard]] bool is_edge(Index i, Index j) const { return edges_.count(key(i, j)) > 0; }
    /// Normal of a filling triangle with positions i < j < k; its orientation is opposite to the border.
    [[nodiscard]] Vector filling_normal(Index i, Index j, Index k) const {
        return CGAL::cross_product(places_[k] - places_[i], places_[j] - places_[i]);
    }

    bool cut_corners(std::vector<Index>& ring, std::size_t maximum, std::vector<Triple>& triangles) {
        const auto n = static_cast<Index>(ring.size());
        std::vector<Index> previous(n), next(n), stamp(n, 0);
        for (Index i = 0; i < n; ++i) previous[i] = (i + n - 1) % n, next[i] = (i + 1) % n;
        struct Corner {
            double chord;
            Index position, stamp;
            bool operator<(const Corner& o) const { return chord != o.chord ? chord > o.chord : position > o.position; }
        };
        std::priority_queue<Corner> queue;
        const auto push = [&](Index i) {
            if (!is_edge(previous[i], next[i]))
                queue.push({CGAL::squared_distance(places_[previous[i]], places_[next[i]]), i, stamp[i]});
        };
        for (Index i = 0; i < n; ++i) push(i);
        std::size_t remaining = n;
        std::vector<std::uint8_t> clipped(n, 0);
        while (remaining > maximum && !queue.empty()) {
            const Corner corner = queue.top();
            queue.pop();
            const Index i = corner.position, p = previous[i], q = next[i];
            if (clipped[i] != 0 || corner.stamp != stamp[i] || is_edge(p, q)) continue;
            Triple t{p, i, q};
            std::sort(t.begin(), t.end());
            triangles.push_back(t);
            const Vector normal = unit(filling_normal(t[0], t[1], t[2]));
            edges_.insert(key(p, q));
            outside_[p] = normal;  // the new side from p to q
            clipped[i] = 1;
            next[p] = q;
            previous[q] = p;
            ++stamp[p], ++stamp[q];
            push(p);
            push(q);
            --remaining;
        }
        ring.clear();
        for (Index i = 0; i < n; ++i)
            if (clipped[i] == 0) ring.push_back(i);
        return remaining <= maximum;
    }

    struct Weight {
        double bend = 0, area = 0;  ///< 1 - cosine of the largest dihedral angle, area
        bool operator<(const Weight& o) const { return bend != o.bend ? bend < o.bend : area < o.area; }
    };

    bool best_triangulation(const std::vector<Index>& ring, std::vector<Triple>& triangles) const {
        const std::size_t n = ring.size();
        constexpr double never = std::numeric_limits<double>::infinity();
        std::vector<Weight> weight(n * n, {never, never});
        std::vector<std::size_t> middle(n * n, 0);
        std::vector<Vector> normals(n * n, Vector(0, 0, 0));  // normal of the triangle chosen beyond each chord
        for (std::size_t i = 0; i + 1 < n; ++i) {
            weight[i * n + i + 1] = {};
            normals[i * n + i + 1] = outside_[ring[i]];
        }
        for (std::size_t span = 2; span < n; ++span)
            for (std::size_t i = 0; i + span < n; ++i) {
                const std::size_t k = i + span;
                const bool closing = i == 0 && k == n - 1;
                if (!closing && is_edge(ring[i], ring[k])) continue;
                for (std::size_t m = i + 1; m < k; ++m) {
                    const Weight &left = weight[i * n + m], &right = weight[m * n + k];
                    if (left.bend == never || right.bend == never ||
                        std::max(left.bend, right.bend) > weight[i * n + k].bend)  // the candidate bends at least as much
                        continue;
                    const Vector filling = filling_normal(ring[i], ring[m], ring[k]);
                    const double length = std::sqrt(filling.squared_length());
                    const Vector direction = length > 0 ? filling / length : filling;
                    Weight candidate{
                        std::max({left.bend, right.bend, 1 - direction * normals[i * n + m], 1 - direction * normals[m * n + k]}),
                        left.area + right.area + length / 2};
                    if (closing) candidate.bend = std::max(candidate.bend, 1 - direction * outside_[ring[k]]);
                    if (length == 0) candidate.bend = std::max(candidate.bend, 3.0);  // a degenerate triangle is the last resort
                    if (candidate < weight[i * n + k]) {
                        weight[i * n + k] = candidate;
                        middle[i * n + k] = m;
                        normals[i * n + k] = direction;
                    }
                }
            }
        if (weight[n - 1].bend == never) return false;
        std::vector<std::pair<std::size_t, std::size_t>> stack{{0, n - 1}};
        while (!stack.empty()) {
            const auto [i, k] = stack.back();
            stack.pop_back();
            if (k - i < 2) continue;
            const std::size_t m = middle[i * n + k];
            triangles.push_back({ring[i], ring[m], ring[k]});
            stack.emplace_back(i, m);
            stack.emplace_back(m, k);
        }
        return true;
    }

    const TriangleSoup& soup_;
    const Hole& hole_;
    std::unordered_set<std::uint64_t> edges_;  ///< pairs of positions connected by an edge, including the border of the hole
    std::vector<Point> places_;
    std::vector<Vector> outside_;  ///< unit normal of the triangle at the side from each position to the next
};

double diameter_of_disc(double area) { return 2 * std::sqrt(area / pi); }

/// Diameter of a disc with the area of the triangle fan from the centroid of the border; near 0 for a straight slit.
double fan_width(const TriangleSoup& soup, const Hole& hole) {
    Vector middle(0, 0, 0);
    const Point base = point(soup, origin(soup, hole.front()));
    for (const Index h : hole) middle += (point(soup, origin(soup, h)) - base) / static_cast<double>(hole.size());
    double area = 0;
    for (const Index h : hole) {
        const Vector a = point(soup, origin(soup, h)) - base - middle, b = point(soup, target(soup, h)) - base - middle;
        area += std::sqrt(CGAL::cross_product(a, b).squared_length()) / 2;
    }
    return diameter_of_disc(area);
}

/// Diameter of a disc with the area of a filling; near 0 also for a curved slit.
double filling_width(const TriangleSoup& soup, const Hole& hole, const std::vector<Triple>& filling) {
    double area = 0;
    for (const auto& [a, b, c] : filling) {
        const Point p = point(soup, origin(soup, hole[a])), q = point(soup, origin(soup, hole[b])),
                    r = point(soup, origin(soup, hole[c]));
        area += std::sqrt(CGAL::cross_product(q - p, r - p).squared_length()) / 2;
    }
    return diameter_of_disc(area);
}

}  // namespace

namespace {

/// Fills the holes within the limits except those in `skip` (given by their first halfedge). `hole_of` receives, for each added
/// triangle, the first halfedge of its hole.
Counts fill_once(RepairSoup& work, const HoleLimits& limits, const std::vector<Index>& skip, std::vector<Index>& hole_of) {
    auto& soup = work.soup;
    const std::vector<Index> opposite = opposite_halfedges(soup);
    const std::vector<Index> place = same_place(soup.points);
    const std::vector<Hole> holes = find_holes(soup, opposite, place);
    DisjointSets sets = joined_vertices(soup);
    std::vector<CGAL::Bbox_3> boxes(holes.empty() ? 0 : soup.points.size());
    for (Index v = 0; v < boxes.size(); ++v) boxes[sets.find(v)] += point(soup, v).bbox();

    std::size_t filled = 0, triangles = 0, too_long = 0, too_wide = 0, refused = 0;
    std::vector<const Hole*> chosen;
    for (const Hole& hole : holes) {
        std::size_t touched = 0;
        for (const Index h : hole) touched += work.touched[origin(soup, h)];
        if (limits.only_touched && 2 * touched < hole.size()) continue;
        if (std::binary_search(skip.begin(), skip.end(), hole.front())) continue;
        if (hole.size() > limits.edges) ++too_long;
        else chosen.push_back(&hole);
    }
    std::vector<std::vector<Triple>> fillings(chosen.size());
    std::vector<std::uint8_t> is_wide(chosen.size(), 0);
    std::vector<Index> component;
    for (const Hole* hole : chosen) component.push_back(sets.find(origin(soup, hole->front())));
    parallel_for(chosen.size(), 1, [&](std::size_t i) {
        const Hole& hole = *chosen[i];
        const double widest = limits.share * diagonal(boxes[component[i]]);
        const bool wide_fan = fan_width(soup, hole) > widest;
        fillings[i] = HoleFiller(soup, opposite, hole).run();
        if (wide_fan && (fillings[i].empty() || filling_width(soup, hole, fillings[i]) > widest)) {
            is_wide[i] = 1;
            fillings[i].clear();
        }
    });
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (is_wide[i] != 0) {
            ++too_wide;
            continue;
        }
        const Hole& hole = *chosen[i];
        if (fillings[i].empty()) {
            ++refused;
            continue;
        }
        ++filled;
        triangles += fillings[i].size();
        for (const auto& [a, b, c] : fillings[i]) {
            const Index like = hole[a] / 3;  // the triangle adjacent to its first corner
            const auto corner = [&](Index p) { return work.corner_like[hole[p] / 3][hole[p] % 3]; };
            hole_of.push_back(hole.front());
            work.add_triangle({origin(soup, hole[a]), origin(soup, hole[c]), origin(soup, hole[b])}, no_index,
                              work.face_like[like], {corner(a), corner(c), corner(b)}, work.flipped[like] != 0);
        }
    }
    // If a hole connects two copies of a split vertex, its filling joins their fans.
    std::size_t rejoined = 0;
    DisjointSets copies(soup.points.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (fillings[i].empty()) continue;
        const Hole& hole = *chosen[i];
        for (std::size_t k = 0; k < hole.size(); ++k) {
            const Index end = target(soup, hole[k]), start = origin(soup, hole[(k + 1) % hole.size()]);
            if (copies.find(end) == copies.find(start)) continue;
            copies.unite(end, start);
            ++rejoined;
        }
    }
    if (rejoined > 0) {
        for (auto& t : soup.triangles)
            for (Index& v : t) v = copies.find(v);
        separate_nonmanifold(work);  // needed if two merged copies were neighbours of the same vertex
        work.drop_isolated(true);
    }
    return {{"holes", limits.only_touched ? chosen.size() + too_long : holes.size()},
            {"filled", filled},
            {"triangles added", triangles},
            {"copies of vertices rejoined", rejoined},
            {"left: too many edges", too_long},
            {"left: too wide", too_wide},
            {"left: no filling", refused}};
}

}  // namespace

Counts fill_holes(RepairSoup& work, const HoleLimits& limits) {
    std::vector<Index> skip, hole_of;
    if (limits.only_touched) return fill_once(work, limits, skip, hole_of);  // the caller checks the result
    const RepairSoup before = work;
    Counts counts = fill_once(work, limits, skip, hole_of);
    if (!hole_of.empty()) {
        // A filling that intersects the surface or another filling is worse than a hole.
        const std::size_t first = before.soup.triangles.size();
        for (const auto& [a, b] : ostraka::self_intersections(work.soup, 1'000'000).pairs)
            for (const Index t : {a, b})
                if (t >= first && t - first < hole_of.size()) skip.push_back(hole_of[t - first]);
        std::sort(skip.begin(), skip.end());
        skip.erase(std::unique(skip.begin(), skip.end()), skip.end());
        if (!skip.empty()) {
            work = before;
            hole_of.clear();
            counts = fill_once(work, limits, skip, hole_of);
        }
    }
    counts.emplace_back("left: a filling would intersect", skip.size());
    return counts;
}

}  // namespace ostraka::detail
