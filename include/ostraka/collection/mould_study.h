// Comparison and grouping of heads, with a summary of each group and head.
#pragma once

#include "ostraka/collection/moulds.h"

#include <optional>

namespace ostraka {

struct MouldStudy {
    MouldMatrices matrices;
    Eigen::MatrixXd distances;
    MouldGroups groups;
    std::vector<ClusterStability> stability;  ///< one per group
    std::vector<double> sizes;                ///< size of each head relative to the mean of its group

    [[nodiscard]] int group_count() const;
    /// Mean distance of a head to the members of a group, excluding the head itself; NaN if there is no other member.
    [[nodiscard]] double mean_distance(std::size_t head, int group) const;
    /// The nearest group other than the head's own and the mean distance to it; -1 if there is no other group.
    [[nodiscard]] std::pair<int, double> second_group(std::size_t head) const;
};

/// Computes distances from a similarity, the groups, their stability, and the relative sizes of the heads. Throws the errors of
/// the functions in moulds.h.
MouldStudy study_moulds(MouldMatrices matrices, const std::string& similarity, const GroupOptions& group = {},
                        const StabilityOptions& stability = {});

struct MouldGroupSummary {
    std::vector<std::string> members;
    std::optional<double> within;      ///< mean distance between members; none for a single head
    std::optional<int> nearest;        ///< group with the smallest mean distance; none if there is no other group
    std::optional<double> to_nearest;  ///< mean distance to the nearest group
    double silhouette = 0;             ///< mean silhouette of the members
};
std::vector<MouldGroupSummary> summarise_groups(const MouldStudy& study);

/// Adjusted Rand index between groups and known labels, over the heads whose label is known (not empty).
double agreement_with_answers(const std::vector<int>& groups, const std::vector<std::string>& answers);

}  // namespace ostraka
