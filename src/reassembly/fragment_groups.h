// Fragments joined to groups, the surest join first.
#pragma once

#include "pair_graph.h"

#include <map>
#include <optional>
#include <set>

namespace ostraka {

class FragmentGroups {
public:
    /// All alone.
    FragmentGroups(const LooseFragments& loose, const PairGraph& graph, const ReassemblyOptions& options);

    /// Joins groups while that is likely enough. `all`: of few fragments each time the best of all as they then are; of many,
    /// what a join promised when it was last looked at stands.
    void merge(bool all);
    /// Likely poses that were not taken.
    [[nodiscard]] std::vector<UndoneJoin> undone() const;

    /// Of two fragments or more, the largest first.
    [[nodiscard]] std::vector<std::vector<std::size_t>> groups() const;
    /// Into the frame of the group.
    [[nodiscard]] const Motion& pose(std::size_t k) const { return poses_[k]; }
    /// Refines the poses of a group together.
    void refine(const std::vector<std::size_t>& group, int rounds);
    /// Pairs of a group that touch where they are, and what is seen of that.
    [[nodiscard]] std::vector<std::pair<std::pair<std::size_t, std::size_t>, JoinEvidence>> meetings(
        const std::vector<std::size_t>& group) const;

private:
    struct Verdict {
        Motion join;  ///< of the second group onto the first
        double log_odds = 0;
        std::string against;  ///< empty: nothing
    };
    struct Seen {
        std::size_t a, b;  ///< versions of the groups
        Verdict verdict;
    };

    [[nodiscard]] FragmentPairs close_pairs(std::size_t a, std::size_t b, const Motion& join) const;
    [[nodiscard]] Motion settled(std::size_t a, std::size_t b, Motion join) const;
    [[nodiscard]] Verdict examine(const PairEdge& edge) const;
    [[nodiscard]] bool up_to_date(std::size_t e) const;
    void look_at(std::size_t e);
    void join_the_surest();
    void join_as_promised();
    void join(const PairEdge& edge, const Motion& move);

    const LooseFragments& loose_;
    const PairGraph& graph_;
    double needed_;                   ///< log odds
    std::vector<std::size_t> order_;  ///< edges, the surest first
    std::vector<Motion> poses_;
    std::map<std::size_t, std::vector<std::size_t>> members_;  ///< of each fragment: its group
    std::vector<std::size_t> version_;                         ///< of each fragment's group
    std::vector<std::size_t> refined_;  ///< of each fragment: how large its group was when it was last refined
    std::size_t versions_ = 0;
    std::vector<std::optional<Seen>> seen_;  ///< of each edge
};

}  // namespace ostraka
