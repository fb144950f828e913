// Graph of fragments with all candidate poses as edges, and the loops that the candidates close.
#pragma once

#include "reassembly/prepared_fragments.h"

#include <cmath>
#include <map>

namespace ostraka {

/// Log odds of a probability.
inline double logit(double p) { return std::log(p / (1 - p)); }
/// Inverse of `logit`.
inline double probability(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

/// Likelihood ratio of a loop closure: how many times more often a correct pose than a wrong pose closes a loop with two correct
/// poses. Inverse of the share of poses within the tolerances of `agree`, with a wide safety margin (poses are not uniformly
/// distributed).
constexpr double loop_gain = 1000;

/// A candidate pose of a pair of fragments.
struct PairEdge {
    std::size_t a, b;      ///< indices of the two fragments, a < b
    Motion pose;           ///< maps fragment b onto fragment a
    double pair_log_odds;  ///< log odds of the pose from the two fragments alone
    double boosted;        ///< log odds of the pose including the loops that it closes
};

/// The registered pairs and their candidate poses.
class PairGraph {
public:
    /// Registers the promising pairs and writes the number of pairs to `result`.
    PairGraph(const PreparedFragments& fragments, const PairEffort& effort, const PairMemory& memory, Reassembly& result);

    [[nodiscard]] const std::vector<PairResult>& pairs() const { return pairs_; }  ///< the registered pairs
    [[nodiscard]] const std::vector<PairEdge>& edges() const { return edges_; }    ///< the candidate poses of all pairs
    /// Indices of the edges between two fragments, i < j; empty for a pair that was not registered.
    [[nodiscard]] const std::vector<std::size_t>& edges_of(std::size_t i, std::size_t j) const;
    /// Probability of a pose, corrected for the number of fragments; `alone`: probability from the two fragments alone.
    [[nodiscard]] double probable(double alone) const;

private:
    /// Registers pairs of fragments, or recalls their results from the cache; `phase`: name of the phase for the progress
    /// display.
    [[nodiscard]] std::vector<PairResult> register_pairs(const std::string& phase, const FragmentPairs& pairs,
                                                         const PairOptions& options, const PairMemory& memory) const;
    void make_edges();   ///< adds an edge for each candidate of each pair
    void close_loops();  ///< raises the log odds of edges that close loops

    const PreparedFragments& fragments_;
    std::vector<PairResult> pairs_;  ///< the registered pairs
    std::vector<PairEdge> edges_;    ///< the candidate poses of all pairs
    /// From two fragments, the lower index first, to the indices of their edges.
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> pair_edges_;
};

}  // namespace ostraka
