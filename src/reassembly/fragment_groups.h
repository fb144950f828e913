// Joins fragments to groups, the most likely join first.
#pragma once

#include "reassembly/pair_graph.h"

#include <map>
#include <optional>
#include <set>

namespace ostraka {

/// Groups of fragments in their current poses.
class FragmentGroups {
public:
    /// Starts with each fragment as a group of its own.
    FragmentGroups(const PreparedFragments& fragments, const PairGraph& graph, const ReassemblyOptions& options);

    /// Joins groups while the probability of a join is at least the minimum. `all_pairs`: true for few fragments, where all edges
    /// of the pair graph are re-evaluated after each join; otherwise an edge is re-evaluated when its turn comes.
    void merge(bool all_pairs);
    /// Likely poses that were rejected, with the reasons.
    [[nodiscard]] std::vector<RejectedJoin> undone() const;

    /// Fragment indices of each group of two or more fragments, largest group first.
    [[nodiscard]] std::vector<std::vector<std::size_t>> groups() const;
    /// Maps fragment `k` into the frame of its group.
    [[nodiscard]] const Motion& pose(std::size_t k) const { return poses_[k]; }
    /// Refines the poses of all fragments of a group together.
    void refine(const std::vector<std::size_t>& group, int rounds);
    /// Pairs of fragments of a group that touch in their current poses, with the evidence for the join.
    [[nodiscard]] std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> meetings(
        const std::vector<std::size_t>& group) const;

private:
    /// Evaluation of a join of two groups.
    struct Verdict {
        Motion join;          ///< maps the second group onto the first
        double log_odds = 0;  ///< log odds of the join
        std::string against;  ///< evidence against the join as text; empty: none
    };
    /// The last evaluation of an edge of the pair graph.
    struct Examination {
        std::size_t a, b;  ///< versions of the two groups at the time of the evaluation
        Verdict verdict;   ///< result of the evaluation
    };

    /// Fragments of groups `a` and `b` that come close under the join.
    [[nodiscard]] FragmentPairs close_pairs(std::size_t a, std::size_t b, const Motion& join) const;
    /// The join, refined by registering group `b` onto group `a`.
    [[nodiscard]] Motion registered(std::size_t a, std::size_t b, Motion join) const;
    [[nodiscard]] Verdict examine(const PairEdge& edge) const;  ///< evaluates the join that an edge proposes
    [[nodiscard]] bool up_to_date(std::size_t e) const;         ///< whether edge `e` was evaluated with the current groups
    void update(std::size_t e);                                 ///< evaluates edge `e`
    void join_eagerly();                                        ///< joins groups with re-evaluation of all edges after each join
    void join_lazily();                                   ///< joins groups with re-evaluation of each edge when its turn comes
    void join(const PairEdge& edge, const Motion& move);  ///< joins the groups of the edge's two fragments by a motion

    const PreparedFragments& fragments_;
    const PairGraph& graph_;
    double min_log_odds_;                                      ///< min log odds of a join
    std::vector<std::size_t> order_;                           ///< edges of the pair graph, by descending probability
    std::vector<Motion> poses_;                                ///< for each fragment, the motion into the frame of its group
    std::map<std::size_t, std::vector<std::size_t>> members_;  ///< for each fragment, the members of its group
    std::vector<std::size_t> version_;                         ///< for each fragment, the version of its group
    std::vector<std::size_t> refined_;  ///< for each fragment, the size of its group when the group was last refined
    std::size_t versions_ = 0;          ///< the last version number given to a group
    std::vector<std::optional<Examination>> examinations_;  ///< for each edge of the pair graph, its last evaluation; empty: none
};

}  // namespace ostraka
