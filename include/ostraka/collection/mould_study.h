// Heads compared, grouped, and what is to be said of each group and head.
#pragma once

#include "ostraka/collection/moulds.h"

#include <optional>

namespace ostraka {

struct MouldStudy {
    MouldMatrices matrices;
    Eigen::MatrixXd distances;
    MouldGroups groups;
    std::vector<ClusterStability> stability;  ///< one a group
    std::vector<double> sizes;                ///< of the heads, against the mean of their group

    [[nodiscard]] int group_count() const;
    /// Mean distance of a head to the members of a group, itself left out; NaN for none.
    [[nodiscard]] double mean_distance(std::size_t head, int group) const;
    /// The nearest group that is not its own and the mean distance to it; -1 for none.
    [[nodiscard]] std::pair<int, double> second_group(std::size_t head) const;
};

/// Distances by a similarity, groups by them, how stable these are, and the sizes of the heads. Throws as the functions of
/// moulds.h do.
MouldStudy study_moulds(MouldMatrices matrices, const std::string& similarity, const GroupOptions& group = {},
                        const StabilityOptions& stability = {});

struct MouldGroupSummary {
    std::vector<std::string> members;
    std::optional<double> within;      ///< mean distance of its members to each other; none for one head
    std::optional<int> nearest;        ///< the group that is nearest by the mean of all distances; none where there is no other
    std::optional<double> to_nearest;  ///< that mean
    double silhouette = 0;             ///< mean of its members
};
std::vector<MouldGroupSummary> summarise_groups(const MouldStudy& study);

/// Adjusted Rand index of groups and known answers, over the heads whose answer is known (not empty).
double agreement_with_answers(const std::vector<int>& groups, const std::vector<std::string>& answers);

}  // namespace ostraka
