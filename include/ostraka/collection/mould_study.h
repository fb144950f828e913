// Compares heads, groups them by mould, and summarises each group and each head.
#pragma once

#include "ostraka/collection/moulds.h"

#include <optional>

namespace ostraka {

/// Heads grouped by mould.
struct MouldStudy {
    MouldMatrices matrices;
    Eigen::MatrixXd distances;  ///< distances between heads, symmetric, 0 to 1
    MouldGroups groups;
    std::vector<ClusterStability> stability;  ///< stability of each group under resampling
    std::vector<double> sizes;                ///< size of each head relative to the mean of its group

    [[nodiscard]] int group_count() const;  ///< number of groups
    /// Mean distance of a head to the other members of a group; NaN if there are no other members.
    [[nodiscard]] double mean_distance(std::size_t head, int group) const;
    /// Among the groups other than the head's own, the index of the group with the smallest mean distance to the head, and this
    /// distance; -1 if there is no other group.
    [[nodiscard]] std::pair<int, double> second_group(std::size_t head) const;
};

/// Computes the distances from a similarity (mould_similarities), then the groups of heads, the stability of the groups, and the
/// relative sizes of the heads. Throws the same errors as `mould_distances` and `group_heads` (moulds.h).
MouldStudy study_moulds(MouldMatrices matrices, const std::string& similarity, const GroupOptions& group = {},
                        const StabilityOptions& stability = {});

/// Summary of one group of heads.
struct MouldGroupSummary {
    std::vector<std::string> members;  ///< names of the heads in the group
    std::optional<double> within;      ///< mean distance between two members; none for a group of one head
    /// Index of the other group with the smallest mean distance; none if there is no other group.
    std::optional<int> nearest;
    /// Mean distance between members of this group and members of the group `nearest`.
    std::optional<double> to_nearest;
    double silhouette = 0;  ///< mean silhouette of the members
};
std::vector<MouldGroupSummary> summarise_groups(const MouldStudy& study);  ///< one per group

/// Adjusted Rand index between the computed groups and the known labels. Heads with an empty label are ignored.
double agreement_with_answers(const std::vector<int>& groups, const std::vector<std::string>& answers);

}  // namespace ostraka
