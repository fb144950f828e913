#include "pair_graph.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"

#include <algorithm>
#include <mutex>
#include <optional>

namespace ostraka {

PairGraph::PairGraph(const LooseFragments& loose, const PairEffort& effort, const PairMemory& memory, Reassembly& result)
    : loose_(loose) {
    const FragmentPairs list = promising_pairs(loose.all(), effort);
    const std::size_t takes_part = loose.taking_part();
    result.pairs_tried = list.size();
    result.pairs_left = takes_part > 0 ? takes_part * (takes_part - 1) / 2 - list.size() : 0;
    pairs_ = tried("lay breaks against each other", list, effort.first, memory);
    if (!effort.all) {
        // Tries the pairs that the first attempt leaves open again, thoroughly.
        constexpr double hopeless = 0.003, beyond_doubt = 0.98;
        std::vector<std::size_t> open;
        for (std::size_t p = 0; p < pairs_.size(); ++p)
            if (pairs_[p].confidence > hopeless && pairs_[p].confidence < beyond_doubt) open.push_back(p);
        std::stable_sort(open.begin(), open.end(),
                         [&](std::size_t x, std::size_t y) { return pairs_[x].confidence > pairs_[y].confidence; });
        if (open.size() > effort.most_thorough) open.resize(effort.most_thorough);
        FragmentPairs again;
        for (const std::size_t p : open) again.push_back(list[p]);
        std::vector<PairOfMany> better = tried("lay the likely ones more thoroughly", again, effort.thorough, memory);
        for (std::size_t k = 0; k < open.size(); ++k) pairs_[open[k]] = std::move(better[k]);
    }
    make_edges();
    close_loops();
}

std::vector<PairOfMany> PairGraph::tried(const std::string& phase, const FragmentPairs& list, const PairOptions& how,
                                         const PairMemory& memory) const {
    std::vector<PairOfMany> result(list.size());
    std::mutex one_at_a_time;
    Progress progress(phase, list.size());
    parallel_for(
        list.size(),
        [&](std::size_t p) {
            check_cancelled();
            const auto [i, j] = list[p];
            std::optional<PairOfMany> pair;
            if (memory.recall) {
                const std::lock_guard lock(one_at_a_time);
                pair = memory.recall(i, j, how);
            }
            if (!pair) {
                BreakPair found = pair_breaks(loose_[i], loose_[j], how);
                pair = PairOfMany{i, j, std::move(found.candidates), found.confidence};
                const std::lock_guard lock(one_at_a_time);
                if (memory.keep) memory.keep(*pair, how);
            }
            result[p] = std::move(*pair);
            progress.advance();
        },
        1);
    return result;
}

double PairGraph::probable(double alone) const {
    return probability(logit(std::clamp(alone, 1e-9, 1 - 1e-9)) + log_odds_of_a_join_among(loose_.count()));
}

void PairGraph::make_edges() {
    constexpr double least = 0.002;
    for (const PairOfMany& pair : pairs_) {
        for (std::size_t c = 0; c < pair.candidates.size(); ++c) {
            const double here = pair.candidates[c].log_odds, best = pair.candidates.front().log_odds,
                         lead = c > 0                        ? here - best
                                : pair.candidates.size() > 1 ? here - pair.candidates[1].log_odds
                                                             : 1e9;
            const double likely = probable(join_probability(here, lead));
            if (likely < least) continue;
            of_pair_[{pair.first, pair.second}].push_back(edges_.size());
            edges_.push_back({pair.first, pair.second, pair.candidates[c].pose, logit(likely), logit(likely)});
        }
    }
}

const std::vector<std::size_t>& PairGraph::edges_of(std::size_t i, std::size_t j) const {
    static const std::vector<std::size_t> none;
    const auto found = of_pair_.find({i, j});
    return found == of_pair_.end() ? none : found->second;
}

/// Edges that close loops of three gain probability from that of the other two.
void PairGraph::close_loops() {
    constexpr int rounds = 2;
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> support(edges_.size(), 0);
        for (const auto& [first, those] : of_pair_) {
            const auto [i, j] = first;
            for (auto next = of_pair_.lower_bound({j, 0}); next != of_pair_.end() && next->first.first == j; ++next) {
                const std::size_t k = next->first.second;
                for (const std::size_t ik : edges_of(i, k))
                    for (const std::size_t ij : those)
                        for (const std::size_t jk : next->second) {
                            if (!loose_.agree(edges_[ij].pose.after(edges_[jk].pose), edges_[ik].pose, k,
                                              loose_.loop_length(i, j, k)))
                                continue;
                            const double p = probability(edges_[ij].boosted), q = probability(edges_[jk].boosted),
                                         r = probability(edges_[ik].boosted);
                            support[ij] += q * r, support[jk] += p * r, support[ik] += p * q;
                        }
            }
        }
        for (std::size_t e = 0; e < edges_.size(); ++e) edges_[e].boosted = edges_[e].own + std::log(1 + loop_gain * support[e]);
    }
}

}  // namespace ostraka
