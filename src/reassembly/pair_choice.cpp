#include "pair_choice.h"

#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"

#include <algorithm>

namespace ostraka {

namespace {

/// All pairs; with many fragments, each fragment with those of most similar fracture width.
FragmentPairs alike_in_width(const std::vector<std::unique_ptr<PreparedBreak>>& fragments, std::size_t reach) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < fragments.size(); ++k)
        if (fragments[k]) order.push_back(k);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return fragments[x]->width() < fragments[y]->width(); });
    FragmentPairs list;
    for (std::size_t r = 0; r < order.size(); ++r)
        for (std::size_t s = r + 1; s < std::min(order.size(), r + 1 + reach); ++s)
            list.emplace_back(std::min(order[r], order[s]), std::max(order[r], order[s]));
    std::sort(list.begin(), list.end());
    return list;
}

}  // namespace

PairEffort effort_among(std::size_t fragments, const ReassemblyOptions& options) {
    const auto partners = static_cast<std::size_t>(options.partners);
    PairEffort effort;
    effort.prepared = effort.first = effort.thorough = options.pairs;
    effort.all = fragments <= partners + 1;
    effort.partners = partners;
    if (effort.all) return effort;
    // From a hundred fragments on, the effort per pair decreases.
    constexpr std::size_t hundred = 100;
    const double share = std::min(1.0, static_cast<double>(hundred) / static_cast<double>(fragments));
    const auto less = [&](int all, int least) { return std::min(all, std::max(least, static_cast<int>(share * all))); };
    PairOptions& first = effort.first;
    // Fractures keep their samples: with a spacing above the tolerance nothing would count as contact.
    first.samples = less(options.pairs.samples, 500);
    effort.prepared.frames = first.frames = effort.thorough.frames = less(options.pairs.frames, 80);
    first.starts = less(std::min(options.pairs.starts, 60), 24);
    first.refined = less(std::min(options.pairs.refined, 8), 6);
    constexpr std::size_t pairs = 6000, few = 6;
    effort.partners = std::min(partners, std::max(few, pairs / fragments));
    effort.most_thorough = 500;
    return effort;
}

FragmentPairs promising_pairs(const std::vector<std::unique_ptr<PreparedBreak>>& fragments, const PairEffort& effort) {
    const FragmentPairs list = alike_in_width(fragments, std::max<std::size_t>(60, 2 * effort.partners));
    if (effort.all) return list;
    // Very many pairs are compared with fewer frames each.
    constexpr std::size_t very_many = 5000;
    const std::size_t places = list.size() > very_many ? 24 : 64;
    std::vector<double> score(list.size());
    Progress progress("compare breaks quickly", list.size());
    parallel_for(
        list.size(),
        [&](std::size_t p) {
            score[p] = quick_fit(*fragments[list[p].first], *fragments[list[p].second], effort.first, places);
            progress.advance();
        },
        16);
    std::vector<std::vector<std::size_t>> of(fragments.size());
    for (std::size_t p = 0; p < list.size(); ++p) of[list[p].first].push_back(p), of[list[p].second].push_back(p);
    std::vector<bool> keep(list.size(), false);
    for (auto& own : of) {
        std::stable_sort(own.begin(), own.end(), [&](std::size_t x, std::size_t y) { return score[x] > score[y]; });
        for (std::size_t k = 0; k < std::min(effort.partners, own.size()); ++k) keep[own[k]] = true;
    }
    FragmentPairs result;
    for (std::size_t p = 0; p < list.size(); ++p)
        if (keep[p]) result.push_back(list[p]);
    return result;
}

}  // namespace ostraka
