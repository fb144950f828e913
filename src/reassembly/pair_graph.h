// All candidates of all pairs that were tried, and the loops they close.
#pragma once

#include "reassembly/prepared_fragments.h"

#include <cmath>
#include <map>

namespace ostraka {

inline double logit(double p) { return std::log(p / (1 - p)); }
inline double probability(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

/// Likelihood ratio of a loop closure: a correct pose closes a loop with two correct ones this many times more often than a
/// wrong pose does. Inverse of the share of poses within the tolerances of `agree`, with a wide safety margin (poses are not
/// uniformly distributed).
constexpr double loop_gain = 1000;

/// A candidate of a pair.
struct PairEdge {
    std::size_t a, b;      ///< a < b
    Motion pose;           ///< maps b onto a
    double pair_log_odds;  ///< log odds from the two fragments alone
    double boosted;        ///< log odds including loops
};

class PairGraph {
public:
    /// Tries the promising pairs and writes their number to `result`.
    PairGraph(const PreparedFragments& fragments, const PairEffort& effort, const PairMemory& memory, Reassembly& result);

    [[nodiscard]] const std::vector<PairResult>& pairs() const { return pairs_; }
    [[nodiscard]] const std::vector<PairEdge>& edges() const { return edges_; }
    /// Candidates of a pair, the lower index first; empty for a pair that was not tried.
    [[nodiscard]] const std::vector<std::size_t>& edges_of(std::size_t i, std::size_t j) const;
    /// Probability of a pair, corrected for the number of fragments.
    [[nodiscard]] double probable(double alone) const;

private:
    [[nodiscard]] std::vector<PairResult> register_pairs(const std::string& phase, const FragmentPairs& pairs,
                                                         const PairOptions& options, const PairMemory& memory) const;
    void make_edges();
    void close_loops();

    const PreparedFragments& fragments_;
    std::vector<PairResult> pairs_;
    std::vector<PairEdge> edges_;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> pair_edges_;  ///< edges; the lower index first
};

}  // namespace ostraka
