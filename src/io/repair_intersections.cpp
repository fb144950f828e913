// Self-intersections removed by cutting out and closing again.
#include "repair_steps.h"
#include "soup_geometry.h"

namespace ostraka::detail {

namespace {

double total_area(const TriangleSoup& soup) {
    double sum = 0;
    for (const auto& t : soup.triangles) sum += area(soup, t);
    return sum;
}

std::size_t count_border(const TriangleSoup& soup) {
    std::size_t count = 0;
    for (const Index o : pair_manifold(soup)) count += o == no_index;
    return count;
}

/// 1 for the triangles in the pairs and those within so many rings of vertices around them.
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

/// Two solids that were joined at a wall, which both of them have: without it they are one.
std::size_t drop_walls(Worksoup& work) {
    const std::vector<Index> place = same_place(work.soup.points);
    std::vector<std::pair<std::array<Index, 3>, Index>> keyed;  // places in increasing order, triangle
    for (Index t = 0; t < work.triangle_count(); ++t) {
        std::array<Index, 3> key{place[work.soup.triangles[t][0]], place[work.soup.triangles[t][1]],
                                 place[work.soup.triangles[t][2]]};
        std::sort(key.begin(), key.end());
        keyed.emplace_back(key, t);
    }
    std::sort(keyed.begin(), keyed.end());
    const auto forward = [&](Index t) {  // does the triangle run through its places in increasing order?
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
    take_apart(work);
    work.drop_isolated(true);
    return dropped;
}

struct Attempt {
    Worksoup work;
    std::size_t removed = 0;
    bool too_much = false;
};

/// Cuts out the triangles of the pairs with so many rings around them and closes the gaps.
Attempt cut_out(const Worksoup& work, const std::vector<std::pair<Index, Index>>& pairs, int rings) {
    Attempt attempt{work};
    Worksoup& trial = attempt.work;
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
    take_apart(trial);
    drop_components(trial, false, 1e-4);  // crumbs that hung on by what was cut
    trial.drop_isolated(true);
    fill_holes(trial, {1'000'000, 1.0, true});
    turn_outwards(trial);
    return attempt;
}

}  // namespace

Counts remove_self_intersections(Worksoup& work, std::vector<std::string>& notes) {
    constexpr std::size_t limit = 1'000'000;
    auto found = ostraka::self_intersections(work.soup, limit);
    const std::size_t before = found.pairs.size();
    std::size_t walls = 0, removed = 0;
    if (before > 0 && (walls = drop_walls(work)) > 0) found = ostraka::self_intersections(work.soup, limit);
    std::size_t border = work.soup.triangles.empty() ? 0 : count_border(work.soup);
    // More rings only where fewer did not help; what did not help is forgotten.
    for (int rings = 0, tries = 0; rings < 6 && tries < 12 && !found.pairs.empty(); ++tries) {
        Attempt attempt = cut_out(work, found.pairs, rings);
        if (attempt.too_much) {
            notes.emplace_back("self-intersections: cutting them out would take more than a fifth of the surface (use --wrap)");
            break;
        }
        auto left = ostraka::self_intersections(attempt.work.soup, limit);
        const std::size_t border_left = count_border(attempt.work.soup);
        if (left.pairs.size() >= found.pairs.size() || border_left > border) {
            ++rings;
            continue;
        }
        work = std::move(attempt.work);
        found = std::move(left);
        border = border_left;
        removed += attempt.removed;
    }
    return {{"pairs found", before},
            {"walls between solids dropped", walls},
            {"triangles cut out", removed},
            {"pairs left", found.pairs.size()}};
}

}  // namespace ostraka::detail
