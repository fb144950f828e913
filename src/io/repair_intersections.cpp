// Self-intersections removed by cutting out and closing again.
#include "repair_parts.h"
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

}  // namespace

Counts remove_self_intersections(Worksoup& work, std::vector<std::string>& notes) {
    auto found = ostraka::self_intersections(work.soup, 1'000'000);
    const std::size_t before = found.pairs.size();
    std::size_t removed = 0, rounds = 0, left = before;
    if (before > 0) {
        const double area_before = total_area(work.soup);
        const std::size_t border_before = count_border(work.soup);
        Worksoup trial = work;
        std::fill(trial.touched.begin(), trial.touched.end(), 0);
        std::size_t trial_removed = 0;
        for (int round = 0; round < 8 && !found.pairs.empty(); ++round) {
            auto cut = neighbourhood(trial.soup, found.pairs, round);
            for (std::size_t t = 0; t < cut.size(); ++t) {
                if (cut[t] == 0) continue;
                ++trial_removed;
                for (const Index v : trial.soup.triangles[t]) trial.touched[v] = 1;
            }
            for (auto& flag : cut) flag ^= 1;
            trial.keep_triangles(cut);
            if (total_area(trial.soup) < 0.8 * area_before) {
                notes.emplace_back("self-intersections: cutting them out would take more than a fifth of the surface (use --wrap)");
                break;
            }
            take_apart(trial);
            // Crumbs the cut has left: what is connected only through cut triangles and tiny.
            drop_components(trial, false, 1e-4);
            trial.drop_isolated(true);
            fill_holes(trial, {1'000'000, 1.0, true});
            turn_outwards(trial);
            found = ostraka::self_intersections(trial.soup, 1'000'000);
            if (found.pairs.size() < left && count_border(trial.soup) <= border_before) {
                work = trial;
                left = found.pairs.size();
                removed = trial_removed;
                rounds = static_cast<std::size_t>(round) + 1;
            }
        }
    }
    return {{"pairs found", before}, {"triangles cut out", removed}, {"rounds", rounds}, {"pairs left", left}};
}

}  // namespace ostraka::detail
