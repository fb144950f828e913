#include "reassembly/pair_graph.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <mutex>
#include <optional>

namespace ostraka {

PairGraph::PairGraph(const PreparedFragments& fragments, const PairEffort& effort, const PairMemory& memory, Reassembly& result)
    : fragments_(fragments) {
    const FragmentPairs pairs = promising_pairs(fragments.prepared(), effort);
    const std::size_t participants = fragments.matched_count();
    result.pairs_tried = pairs.size();
    result.pairs_left = participants > 0 ? participants * (participants - 1) / 2 - pairs.size() : 0;
    pairs_ = register_pairs("register pairs of fractures", pairs, effort.first, memory);
    if (!effort.all_pairs) {
        // Tries the pairs that the first attempt leaves open again, thoroughly.
        constexpr double hopeless = 0.003, beyond_doubt = 0.98;
        std::vector<std::size_t> open;
        for (std::size_t p = 0; p < pairs_.size(); ++p)
            if (pairs_[p].confidence > hopeless && pairs_[p].confidence < beyond_doubt) open.push_back(p);
        std::stable_sort(open.begin(), open.end(),
                         [&](std::size_t x, std::size_t y) { return pairs_[x].confidence > pairs_[y].confidence; });
        if (open.size() > effort.max_thorough) open.resize(effort.max_thorough);
        FragmentPairs open_pairs;
        for (const std::size_t p : open) open_pairs.push_back(pairs[p]);
        std::vector<PairResult> better = register_pairs("register likely pairs thoroughly", open_pairs, effort.thorough, memory);
        for (std::size_t k = 0; k < open.size(); ++k) pairs_[open[k]] = std::move(better[k]);
    }
    make_edges();
    close_loops();
}

std::vector<PairResult> PairGraph::register_pairs(const std::string& phase, const FragmentPairs& pairs,
                                                  const PairOptions& options, const PairMemory& memory) const {
    std::vector<PairResult> result(pairs.size());
    std::mutex memory_mutex;
    Progress progress(phase, pairs.size());
    parallel_for(pairs.size(), 1, [&](std::size_t p) {
        check_cancelled();
        const auto [i, j] = pairs[p];
        std::optional<PairResult> pair;
        if (memory.load) {
            const std::lock_guard lock(memory_mutex);
            pair = memory.load(i, j, options);
        }
        if (!pair) {
            PairRegistration registration = register_fractures(fragments_[i], fragments_[j], options);
            pair = PairResult{i, j, std::move(registration.candidates), registration.confidence};
            const std::lock_guard lock(memory_mutex);
            if (memory.store) memory.store(*pair, options);
        }
        result[p] = std::move(*pair);
        progress.advance();
    });
    return result;
}

double PairGraph::probable(double alone) const {
    return probability(logit(std::clamp(alone, 1e-9, 1 - 1e-9)) + join_log_odds_correction(fragments_.count()));
}

void PairGraph::make_edges() {
    constexpr double min_probability = 0.002;
    for (const PairResult& pair : pairs_) {
        for (std::size_t c = 0; c < pair.candidates.size(); ++c) {
            const double log_odds = pair.candidates[c].log_odds, best = pair.candidates.front().log_odds,
                         lead = c > 0                        ? log_odds - best
                                : pair.candidates.size() > 1 ? log_odds - pair.candidates[1].log_odds
                                                             : 1e9;
            const double likely = probable(join_probability(log_odds, lead));
            if (likely < min_probability) continue;
            pair_edges_[{pair.first, pair.second}].push_back(edges_.size());
            edges_.push_back({pair.first, pair.second, pair.candidates[c].pose, logit(likely), logit(likely)});
        }
    }
}

const std::vector<std::size_t>& PairGraph::edges_of(std::size_t i, std::size_t j) const {
    static const std::vector<std::size_t> none;
    const auto entry = pair_edges_.find({i, j});
    return entry == pair_edges_.end() ? none : entry->second;
}

/// Edges that close loops of three gain probability from that of the other two.
void PairGraph::close_loops() {
    constexpr int rounds = 2;
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> support(edges_.size(), 0);
        for (const auto& [first, ij_edges] : pair_edges_) {
            const auto [i, j] = first;
            for (auto next = pair_edges_.lower_bound({j, 0}); next != pair_edges_.end() && next->first.first == j; ++next) {
                const std::size_t k = next->first.second;
                for (const std::size_t ik : edges_of(i, k))
                    for (const std::size_t ij : ij_edges)
                        for (const std::size_t jk : next->second) {
                            if (!fragments_.agree(edges_[ij].pose.after(edges_[jk].pose), edges_[ik].pose, k,
                                                  fragments_.loop_length(i, j, k)))
                                continue;
                            const double p = probability(edges_[ij].boosted), q = probability(edges_[jk].boosted),
                                         r = probability(edges_[ik].boosted);
                            support[ij] += q * r, support[jk] += p * r, support[ik] += p * q;
                        }
            }
        }
        for (std::size_t e = 0; e < edges_.size(); ++e)
            edges_[e].boosted = edges_[e].pair_log_odds + std::log(1 + loop_gain * support[e]);
    }
}

}  // namespace ostraka
