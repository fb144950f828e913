// Removal of self-intersections: folds are smoothed; remaining intersecting triangles are cut out and the gaps are filled.
#include "io/repair_steps.h"

#include "io/soup_geometry.h"
#include "ostraka/core/progress.h"

namespace ostraka::detail {

namespace {

double total_area(const TriangleSoup& soup) {
    double sum = 0;
    for (const auto& t : soup.triangles) sum += area(soup, t);
    return sum;
}

/// 1 for the triangles in the pairs and in the given number of vertex rings around them.
std::vector<std::uint8_t> neighbourhood(const TriangleSoup& soup, const std::vector<std::pair<Index, Index>>& pairs, int rings) {
    std::vector<std::uint8_t> chosen(soup.triangles.size(), 0);
    for (const auto& [a, b] : pairs) chosen[a] = chosen[b] = 1;
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<std::uint8_t> near(soup.points.size(), 0);
        for (std::size_t t = 0; t < chosen.size(); ++t)
            if (chosen[t] != 0)
                for (const Index v : soup.triangles[t]) near[v] = 1;
        for (std::size_t t = 0; t < chosen.size(); ++t)
            for (const Index v : soup.triangles[t])
                if (near[v] != 0) chosen[t] = 1;
    }
    return chosen;
}

/// Removes the common wall of two adjacent solids, which is contained twice in the soup: without it they form one solid.
std::size_t drop_walls(RepairSoup& work) {
    const std::vector<Index> place = same_place(work.soup.points);
    std::vector<std::pair<std::array<Index, 3>, Index>> keyed;  // positions in increasing order, triangle
    for (Index t = 0; t < work.triangle_count(); ++t) {
        std::array<Index, 3> key{place[work.soup.triangles[t][0]], place[work.soup.triangles[t][1]],
                                 place[work.soup.triangles[t][2]]};
        std::sort(key.begin(), key.end());
        keyed.emplace_back(key, t);
    }
    std::sort(keyed.begin(), keyed.end());
    const auto forward = [&](Index t) {  // does the triangle traverse its positions in increasing order?
        const auto& corners = work.soup.triangles[t];
        const std::array<Index, 3> p{place[corners[0]], place[corners[1]], place[corners[2]]};
        return (p[0] < p[1]) + (p[1] < p[2]) + (p[2] < p[0]) == 2;
    };
    std::vector<std::uint8_t> keep(work.triangle_count(), 1);
    std::vector<Index> joined(work.soup.points.size());
    for (Index v = 0; v < joined.size(); ++v) joined[v] = v;
    std::size_t dropped = 0;
    for (std::size_t i = 0; i + 1 < keyed.size(); ++i) {
        if (keyed[i].first != keyed[i + 1].first || forward(keyed[i].second) == forward(keyed[i + 1].second)) continue;
        for (const std::size_t k : {i, i + 1}) {
            keep[keyed[k].second] = 0;
            for (const Index v : work.soup.triangles[keyed[k].second]) joined[v] = place[v];
        }
        dropped += 2;
        ++i;
    }
    if (dropped == 0) return 0;
    work.keep_triangles(keep);
    for (auto& t : work.soup.triangles)
        for (Index& v : t) v = joined[v];
    separate_nonmanifold(work);
    work.drop_isolated(true);
    return dropped;
}

using Pairs = std::vector<std::pair<Index, Index>>;
constexpr std::size_t pair_limit = 1'000'000;

/// Vertices near the pairs, in connected sets; -1 elsewhere and on the border, which is fixed.
struct Folds {
    std::vector<Index> set;    ///< set of each vertex
    std::vector<Index> moved;  ///< vertices in a set
    std::vector<std::vector<Index>> neighbours;
};

Folds find_folds(const TriangleSoup& soup, const Pairs& pairs, int rings) {
    const auto near_folds = neighbourhood(soup, pairs, rings);
    DisjointSets sets(soup.points.size());
    for (const auto& [a, b] : pairs) sets.unite(soup.triangles[a][0], soup.triangles[b][0]);
    std::vector<std::uint8_t> inside(soup.points.size(), 0);
    for (std::size_t t = 0; t < near_folds.size(); ++t) {
        if (near_folds[t] == 0) continue;
        for (const Index v : soup.triangles[t]) {
            inside[v] = 1;
            sets.unite(soup.triangles[t][0], v);
        }
    }
    const std::vector<Index> opposite = opposite_halfedges(soup);
    for (Index h = 0; h < opposite.size(); ++h)
        if (opposite[h] == no_index) inside[origin(soup, h)] = inside[target(soup, h)] = 0;
    Folds folds{std::vector<Index>(soup.points.size(), no_index), {}, {}};
    std::vector<Index> number(soup.points.size(), no_index);
    for (Index v = 0; v < inside.size(); ++v) {
        if (inside[v] == 0) continue;
        folds.set[v] = sets.find(v);
        number[v] = static_cast<Index>(folds.moved.size());
        folds.moved.push_back(v);
    }
    folds.neighbours.resize(folds.moved.size());
    for (Index h = 0; h < opposite.size(); ++h)
        if (const Index n = number[origin(soup, h)]; n != no_index) folds.neighbours[n].push_back(target(soup, h));
    return folds;
}

/// Laplacian smoothing of the fold vertices, a few iterations.
void smooth(TriangleSoup& soup, const Folds& folds) {
    constexpr int passes = 5;
    std::vector<std::array<double, 3>> next(folds.moved.size());
    for (int pass = 0; pass < passes; ++pass) {
        check_cancelled();
        for (std::size_t i = 0; i < next.size(); ++i) {
            next[i] = {0, 0, 0};
            for (const Index n : folds.neighbours[i])
                for (std::size_t k = 0; k < 3; ++k)
                    next[i][k] += soup.points[n][k] / static_cast<double>(folds.neighbours[i].size());
        }
        for (std::size_t i = 0; i < next.size(); ++i) soup.points[folds.moved[i]] = next[i];
    }
}

/// For each set, 1 if folds cover a large part of a component, which would shrink as a whole if smoothed.
std::vector<std::uint8_t> wide_folds(const TriangleSoup& soup, const Folds& folds) {
    constexpr double min_share = 0.2;
    DisjointSets components = joined_vertices(soup);
    std::vector<std::size_t> totals(soup.points.size(), 0), folded(soup.points.size(), 0);
    for (Index v = 0; v < totals.size(); ++v) {
        ++totals[components.find(v)];
        folded[components.find(v)] += folds.set[v] != no_index;
    }
    std::vector<std::uint8_t> result(soup.points.size(), 0);
    for (const Index v : folds.moved)
        if (const Index c = components.find(v); static_cast<double>(folded[c]) > min_share * static_cast<double>(totals[c]))
            result[folds.set[v]] = 1;
    return result;
}

/// Smooths folds without changing the topology. The new positions are kept only if a fold is removed completely. Returns the
/// number of moved vertices.
std::size_t relax(RepairSoup& work, Pairs& intersections) {
    constexpr int max_rings = 2;
    std::vector<std::uint8_t> moved(work.soup.points.size(), 0);
    for (int rings = 0; rings <= max_rings && !intersections.empty(); ++rings) {
        const Folds folds = find_folds(work.soup, intersections, rings);
        TriangleSoup trial = work.soup;
        smooth(trial, folds);
        std::vector<std::uint8_t> stays_folded = wide_folds(work.soup, folds);
        for (const auto& [a, b] : ostraka::self_intersections(trial, pair_limit).pairs)
            for (const Index t : {a, b})
                for (const Index v : trial.triangles[t])
                    if (folds.set[v] != no_index) stays_folded[folds.set[v]] = 1;
        for (const Index v : folds.moved)
            if (stays_folded[folds.set[v]] != 0) trial.points[v] = work.soup.points[v];
        auto remaining = ostraka::self_intersections(trial, pair_limit).pairs;
        if (remaining.size() >= intersections.size()) continue;
        for (const Index v : folds.moved)
            if (stays_folded[folds.set[v]] == 0) moved[v] = 1;
        work.soup.points = std::move(trial.points);
        intersections = std::move(remaining);
    }
    return static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
}

/// Quantities that cutting out triangles could change unintentionally.
struct Topology {
    std::size_t components = 0, border = 0;
    long long euler = 0;
};

Topology topology(const TriangleSoup& soup) {
    Topology result;
    DisjointSets sets = joined_vertices(soup);
    std::vector<std::uint8_t> used(soup.points.size(), 0);
    for (const auto& t : soup.triangles)
        for (const Index v : t) used[v] = 1;
    for (Index v = 0; v < used.size(); ++v) {
        result.components += used[v] != 0 && sets.find(v) == v;
        result.euler += used[v];
    }
    const SoupEdges edges = group_edges(soup);
    for (std::size_t e = 0; e < edges.count(); ++e) result.border += edges.valence(e) == 1;
    result.euler += static_cast<long long>(soup.triangles.size()) - static_cast<long long>(edges.count());
    return result;
}

struct Attempt {
    RepairSoup work;
    std::size_t removed = 0;
    bool too_much = false;
};

/// Cuts out the triangles of the pairs and the given number of rings around them, and fills the gaps.
Attempt cut_out(const RepairSoup& work, const std::vector<std::pair<Index, Index>>& pairs, int rings) {
    Attempt attempt{work};
    RepairSoup& trial = attempt.work;
    const double area_before = total_area(trial.soup);
    auto cut = neighbourhood(trial.soup, pairs, rings);
    std::fill(trial.touched.begin(), trial.touched.end(), 0);
    for (std::size_t t = 0; t < cut.size(); ++t) {
        if (cut[t] != 0) {
            ++attempt.removed;
            for (const Index v : trial.soup.triangles[t]) trial.touched[v] = 1;
        }
        cut[t] ^= 1;
    }
    trial.keep_triangles(cut);
    attempt.too_much = total_area(trial.soup) < 0.8 * area_before;
    if (attempt.too_much) return attempt;
    separate_nonmanifold(trial);
    drop_components(trial, false, 1e-4);  // small fragments that were connected only through the removed triangles
    trial.drop_isolated(true);
    fill_holes(trial, {1'000'000, 1.0, true});
    orient_outwards(trial);
    return attempt;
}

}  // namespace

namespace {

/// Cuts with 0 to 5 rings, more only if fewer did not help. An attempt is accepted if fewer pairs are left and the border has
/// not grown and, with `same_topology`, if the number of components and the Euler characteristic are unchanged. Returns the
/// number of removed triangles.
std::size_t cut_and_close(RepairSoup& work, Pairs& intersections, bool same_topology, std::vector<std::string>& notes) {
    constexpr int max_rings = 6, max_tries = 12;
    std::size_t removed = 0;
    Topology before = topology(work.soup);
    for (int rings = 0, tries = 0; rings < max_rings && tries < max_tries && !intersections.empty(); ++tries) {
        Attempt attempt = cut_out(work, intersections, rings);
        if (attempt.too_much) {
            if (!same_topology)
                notes.emplace_back(
                    "self-intersections: cutting them out would take more than a fifth of the surface (use --wrap)");
            break;
        }
        auto remaining = ostraka::self_intersections(attempt.work.soup, pair_limit);
        const Topology after = topology(attempt.work.soup);
        const bool changed = after.components != before.components || after.euler != before.euler;
        if (remaining.pairs.size() >= intersections.size() || after.border > before.border || (same_topology && changed)) {
            ++rings;
            continue;
        }
        work = std::move(attempt.work);
        intersections = std::move(remaining.pairs);
        before = after;
        removed += attempt.removed;
    }
    return removed;
}

}  // namespace

Counts remove_self_intersections(RepairSoup& work, std::vector<std::string>& notes) {
    Pairs intersections = ostraka::self_intersections(work.soup, pair_limit).pairs;
    const std::size_t before = intersections.size();
    std::size_t walls = 0;
    if (before > 0 && (walls = drop_walls(work)) > 0) intersections = ostraka::self_intersections(work.soup, pair_limit).pairs;
    // The least destructive method first; skipped if there are at least as many pairs as triangles, since there are no separate
    // folds then.
    const bool local = intersections.size() < work.soup.triangles.size();
    const std::size_t moved = local ? relax(work, intersections) : 0;
    std::size_t removed = local ? cut_and_close(work, intersections, true, notes) : 0;
    removed += cut_and_close(work, intersections, false, notes);
    return {{"pairs found", before},
            {"walls between solids dropped", walls},
            {"vertices moved to smooth folds", moved},
            {"triangles cut out", removed},
            {"pairs left", intersections.size()}};
}

}  // namespace ostraka::detail
