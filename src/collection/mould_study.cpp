#include "ostraka/collection/mould_study.h"

#include "ostraka/stats/scores.h"

#include <algorithm>
#include <limits>
#include <map>

namespace ostraka {

int MouldStudy::group_count() const {
    return groups.labels.empty() ? 0 : *std::max_element(groups.labels.begin(), groups.labels.end()) + 1;
}

double MouldStudy::mean_distance(std::size_t head, int group) const {
    double sum = 0;
    int count = 0;
    for (std::size_t j = 0; j < groups.labels.size(); ++j) {
        if (groups.labels[j] != group || j == head) continue;
        sum += distances(static_cast<Eigen::Index>(head), static_cast<Eigen::Index>(j));
        ++count;
    }
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

std::pair<int, double> MouldStudy::second_group(std::size_t head) const {
    std::pair<int, double> best{-1, 0};
    for (int group = 0; group < group_count(); ++group) {
        if (group == groups.labels[head]) continue;
        const double d = mean_distance(head, group);
        if (best.first < 0 || d < best.second) best = {group, d};
    }
    return best;
}

MouldStudy study_moulds(MouldMatrices matrices, const std::string& similarity, const GroupOptions& group,
                        const StabilityOptions& stability) {
    MouldStudy study;
    study.matrices = std::move(matrices);
    study.distances = mould_distances(study.matrices, similarity);
    study.groups = group_heads(study.distances, group);
    study.stability = group_stability(study.distances, study.groups, group, stability);
    study.sizes = relative_sizes(study.matrices, study.groups.labels);
    return study;
}

std::vector<MouldGroupSummary> summarise_groups(const MouldStudy& study) {
    const auto& labels = study.groups.labels;
    std::vector<MouldGroupSummary> summaries(static_cast<std::size_t>(study.group_count()));
    for (std::size_t group = 0; group < summaries.size(); ++group) {
        MouldGroupSummary& summary = summaries[group];
        double within = 0;
        int pairs = 0;
        std::vector<double> distance_to(summaries.size(), 0);
        std::vector<int> counts(distance_to.size(), 0);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            if (labels[i] != static_cast<int>(group)) continue;
            summary.silhouette += study.groups.head_silhouettes[i];
            summary.members.push_back(study.matrices.names[i]);
            for (std::size_t j = 0; j < labels.size(); ++j) {
                const double d = study.distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
                const auto other = static_cast<std::size_t>(labels[j]);
                if (other != group) distance_to[other] += d, ++counts[other];
                else if (j != i) within += d, ++pairs;
            }
        }
        summary.silhouette /= static_cast<double>(summary.members.size());
        if (pairs > 0) summary.within = within / pairs;
        for (std::size_t other = 0; other < distance_to.size(); ++other) {
            if (counts[other] == 0 || (summary.to_nearest && distance_to[other] / counts[other] >= *summary.to_nearest)) continue;
            summary.nearest = static_cast<int>(other);
            summary.to_nearest = distance_to[other] / counts[other];
        }
    }
    return summaries;
}

double agreement_with_answers(const std::vector<int>& groups, const std::vector<std::string>& answers) {
    std::map<std::string, int> numbers;
    std::vector<int> labelled_groups, truth;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        if (answers[i].empty()) continue;
        labelled_groups.push_back(groups[i]);
        truth.push_back(numbers.try_emplace(answers[i], static_cast<int>(numbers.size())).first->second);
    }
    return adjusted_rand_index(labelled_groups, truth);
}

}  // namespace ostraka
