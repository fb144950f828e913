// Joins fragments to groups, most certain join first.
#pragma once

#include "reassembly/pair_graph.h"

#include <map>
#include <optional>
#include <set>

namespace ostraka {

class FragmentGroups {
public:
    /// Starts with single fragments.
    FragmentGroups(const PreparedFragments& fragments, const PairGraph& graph, const ReassemblyOptions& options);

    /// Joins groups while the probability is high enough. `all_pairs`: few fragments, all edges are re-evaluated after each join;
    /// otherwise edges are re-evaluated lazily.
    void merge(bool all_pairs);
    /// Likely poses that were rejected.
    [[nodiscard]] std::vector<RejectedJoin> undone() const;

    /// Groups of two or more fragments, largest first.
    [[nodiscard]] std::vector<std::vector<std::size_t>> groups() const;
    /// Maps the fragment into the frame of its group.
    [[nodiscard]] const Motion& pose(std::size_t k) const { return poses_[k]; }
    /// Refines the poses of a group together.
    void refine(const std::vector<std::size_t>& group, int rounds);
    /// Pairs of a group that touch in their current poses, with their evidence.
    [[nodiscard]] std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> meetings(
        const std::vector<std::size_t>& group) const;

private:
    struct Verdict {
        Motion join;  ///< maps the second group onto the first
        double log_odds = 0;
        std::string against;  ///< evidence against the join; empty: none
    };
    struct Examination {
        std::size_t a, b;  ///< versions of the groups
        Verdict verdict;
    };

    [[nodiscard]] FragmentPairs close_pairs(std::size_t a, std::size_t b, const Motion& join) const;
    [[nodiscard]] Motion registered(std::size_t a, std::size_t b, Motion join) const;
    [[nodiscard]] Verdict examine(const PairEdge& edge) const;
    [[nodiscard]] bool up_to_date(std::size_t e) const;
    void update(std::size_t e);
    void join_eagerly();
    void join_lazily();
    void join(const PairEdge& edge, const Motion& move);

    const PreparedFragments& fragments_;
    const PairGraph& graph_;
    double min_log_odds_;             ///< min log odds of a join
    std::vector<std::size_t> order_;  ///< edges, most certain first
    std::vector<Motion> poses_;
    std::map<std::size_t, std::vector<std::size_t>> members_;  ///< per fragment: the members of its group
    std::vector<std::size_t> version_;                         ///< per fragment: version of its group
    std::vector<std::size_t> refined_;                         ///< per fragment: size of its group when it was last refined
    std::size_t versions_ = 0;
    std::vector<std::optional<Examination>> examinations_;  ///< per edge
};

}  // namespace ostraka
