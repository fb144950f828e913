#include "reassembly/pair_choice.h"

#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>

namespace ostraka {

namespace {

/// All pairs; with many fragments, each fragment with those of most similar fracture width.
FragmentPairs pairs_of_similar_width(const std::vector<std::unique_ptr<PreparedFracture>>& fragments,
                                     std::size_t max_neighbours) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < fragments.size(); ++k)
        if (fragments[k]) order.push_back(k);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return fragments[x]->width() < fragments[y]->width(); });
    FragmentPairs pairs;
    for (std::size_t r = 0; r < order.size(); ++r)
        for (std::size_t s = r + 1; s < std::min(order.size(), r + 1 + max_neighbours); ++s)
            pairs.emplace_back(std::min(order[r], order[s]), std::max(order[r], order[s]));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace

PairEffort pair_effort(std::size_t fragments, const ReassemblyOptions& options) {
    const auto partners = static_cast<std::size_t>(options.partners);
    PairEffort effort;
    effort.prepared = effort.first = effort.thorough = options.pairs;
    effort.all_pairs = fragments <= partners + 1;
    effort.partners = partners;
    if (effort.all_pairs) return effort;
    // From a hundred fragments on, the effort per pair decreases.
    constexpr std::size_t hundred = 100;
    const double ratio = std::min(1.0, static_cast<double>(hundred) / static_cast<double>(fragments));
    const auto reduced = [&](int full, int minimum) { return std::min(full, std::max(minimum, static_cast<int>(ratio * full))); };
    PairOptions& first = effort.first;
    // Fractures keep their samples: with a spacing above the tolerance nothing would count as contact.
    first.samples = reduced(options.pairs.samples, 500);
    effort.prepared.frames = first.frames = effort.thorough.frames = reduced(options.pairs.frames, 80);
    first.starts = reduced(std::min(options.pairs.starts, 60), 24);
    first.refined = reduced(std::min(options.pairs.refined, 8), 6);
    constexpr std::size_t pairs = 6000, few = 6;
    effort.partners = std::min(partners, std::max(few, pairs / fragments));
    effort.max_thorough = 500;
    return effort;
}

FragmentPairs promising_pairs(const std::vector<std::unique_ptr<PreparedFracture>>& fragments, const PairEffort& effort) {
    FragmentPairs pairs = pairs_of_similar_width(fragments, std::max<std::size_t>(60, 2 * effort.partners));
    if (effort.all_pairs) return pairs;
    // Very many pairs are compared with fewer frames each.
    constexpr std::size_t very_many = 5000;
    const std::size_t places = pairs.size() > very_many ? 24 : 64;
    std::vector<double> score(pairs.size());
    Progress progress("compare fractures quickly", pairs.size());
    parallel_for(pairs.size(), 16, [&](std::size_t p) {
        score[p] = initial_pair_score(*fragments[pairs[p].first], *fragments[pairs[p].second], effort.first, places);
        progress.advance();
    });
    std::vector<std::vector<std::size_t>> fragment_pairs(fragments.size());
    for (std::size_t p = 0; p < pairs.size(); ++p)
        fragment_pairs[pairs[p].first].push_back(p), fragment_pairs[pairs[p].second].push_back(p);
    std::vector<bool> kept(pairs.size(), false);
    for (auto& pair_indices : fragment_pairs) {
        std::stable_sort(pair_indices.begin(), pair_indices.end(),
                         [&](std::size_t x, std::size_t y) { return score[x] > score[y]; });
        for (std::size_t k = 0; k < std::min(effort.partners, pair_indices.size()); ++k) kept[pair_indices[k]] = true;
    }
    FragmentPairs result;
    for (std::size_t p = 0; p < pairs.size(); ++p)
        if (kept[p]) result.push_back(pairs[p]);
    return result;
}

}  // namespace ostraka
