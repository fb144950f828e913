#include "ostraka/collection/moulds.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/clustering.h"
#include "ostraka/stats/embedding.h"
#include "ostraka/stats/k_means.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>

namespace ostraka {

namespace {

/// Renumbers labels by decreasing group size, then by first member.
std::vector<int> by_size(const std::vector<int>& labels) {
    std::map<int, std::pair<int, int>> groups;  // size (negative), first member
    for (std::size_t i = 0; i < labels.size(); ++i) {
        auto& [size, first] = groups.try_emplace(labels[i], 0, static_cast<int>(i)).first->second;
        --size;
    }
    std::vector<std::pair<std::pair<int, int>, int>> order;
    for (const auto& [label, group] : groups) order.emplace_back(group, label);
    std::sort(order.begin(), order.end());
    std::map<int, int> new_label;
    for (std::size_t i = 0; i < order.size(); ++i) new_label[order[i].second] = static_cast<int>(i);
    std::vector<int> result;
    for (const int label : labels) result.push_back(new_label[label]);
    return result;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// Mean over the heads of the mean distance to the k nearest other heads.
double knn_epsilon(const Eigen::MatrixXd& d, int k) {
    double sum = 0;
    for (Eigen::Index i = 0; i < d.rows(); ++i) {
        std::vector<double> row;
        for (Eigen::Index j = 0; j < d.cols(); ++j)
            if (j != i) row.push_back(d(i, j));
        std::sort(row.begin(), row.end());
        row.resize(std::min(row.size(), static_cast<std::size_t>(std::max(k, 1))));
        sum += mean(row);
    }
    return d.rows() > 0 ? sum / static_cast<double>(d.rows()) : 0;
}

/// Knee of the sorted nearest-neighbour distances: the point farthest below the chord between the ends of the curve (Satopaa,
/// Albrecht, Irwin and Raghavan 2011).
double knee_epsilon(const Eigen::MatrixXd& d) {
    std::vector<double> nearest;
    for (Eigen::Index i = 0; i < d.rows(); ++i) {
        double minimum = std::numeric_limits<double>::infinity();
        for (Eigen::Index j = 0; j < d.cols(); ++j)
            if (j != i) minimum = std::min(minimum, d(i, j));
        if (std::isfinite(minimum)) nearest.push_back(minimum);
    }
    if (nearest.empty()) return 0;
    std::sort(nearest.begin(), nearest.end());
    const double low = nearest.front(), high = nearest.back();
    double maximum = 0, knee = high;
    for (std::size_t i = 0; i < nearest.size() && high > low; ++i) {
        const double fraction = static_cast<double>(i) / static_cast<double>(nearest.size() - 1);
        const double below = fraction - (nearest[i] - low) / (high - low);
        if (below > maximum) maximum = below, knee = nearest[i];
    }
    return knee;
}

class Grouping {
public:
    Grouping(const Eigen::MatrixXd& distances, const GroupOptions& options)
        : d_(distances),
          tree_(linkage(distances,
                        options.method == GroupOptions::Method::linkage ? LinkageMethod::average : LinkageMethod::single)) {}

    [[nodiscard]] std::vector<int> at(double epsilon) const { return cut_at(tree_, epsilon); }

    /// The cut of the tree with the largest mean silhouette: the height midway between its two merges, and the silhouette; the
    /// top of the tree and -2 if there is no such cut.
    [[nodiscard]] std::pair<double, double> best_epsilon() const {
        std::pair<double, double> result{top(), -2};
        for (std::size_t i = 0; i + 1 < tree_.merges.size(); ++i) {
            const double low = tree_.merges[i].height, high = tree_.merges[i + 1].height;
            if (!(high > low)) continue;
            const double value = mean(silhouettes_of_distances(d_, at(low)));
            if (value > result.second) result = {(low + high) / 2, value};
        }
        return result;
    }
    [[nodiscard]] const Linkage& tree() const { return tree_; }
    [[nodiscard]] double top() const { return tree_.merges.empty() ? 0 : tree_.merges.back().height; }

private:
    const Eigen::MatrixXd& d_;
    Linkage tree_;
};

Eigen::MatrixXd submatrix(const Eigen::MatrixXd& d, const std::vector<std::size_t>& heads) {
    const auto n = static_cast<Eigen::Index>(heads.size());
    Eigen::MatrixXd part(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            part(i, j) = d(static_cast<Eigen::Index>(heads[static_cast<std::size_t>(i)]),
                           static_cast<Eigen::Index>(heads[static_cast<std::size_t>(j)]));
    return part;
}

/// Minimum silhouette of distinct groups. Synthetic heads of a single mould, and heads each of its own mould, stay below both
/// values (doc/moulds.md). An embedding exaggerates differences and needs a larger value.
constexpr double min_silhouette_in_distances = 0.2, min_silhouette_in_embedding = 0.7;

/// Splits recursively into distinct groups. In an embedding, where small differences can look large, the groups must also be
/// distinct in the original distances. Returns the largest height at which a group is connected.
double nested_groups(const Eigen::MatrixXd& d, const Eigen::MatrixXd& distances, const GroupOptions& options,
                     const std::vector<std::size_t>& heads, std::vector<int>& labels, int& next) {
    const Eigen::MatrixXd head_distances = submatrix(d, heads);
    const Grouping grouping(head_distances, options);
    const auto [epsilon, silhouette] = grouping.best_epsilon();
    const bool embedded = options.method == GroupOptions::Method::embedding;
    const bool are_distinct = silhouette >= (embedded ? min_silhouette_in_embedding : min_silhouette_in_distances) &&
                              (!embedded || mean(silhouettes_of_distances(submatrix(distances, heads), grouping.at(epsilon))) >=
                                                min_silhouette_in_distances);
    if (!are_distinct) {
        for (const std::size_t head : heads) labels[head] = next;
        ++next;
        return grouping.top();
    }
    const std::vector<int> parts = grouping.at(epsilon);
    const int count = *std::max_element(parts.begin(), parts.end()) + 1;
    double height = 0;
    for (int part = 0; part < count; ++part) {
        std::vector<std::size_t> members;
        for (std::size_t i = 0; i < heads.size(); ++i)
            if (parts[i] == part) members.push_back(heads[i]);
        height = std::max(height, nested_groups(d, distances, options, members, labels, next));
    }
    return height;
}

enum class EpsilonRule { knn, volume, knee, silhouette, nested, number };

/// `value` is set if the rule is a number.
EpsilonRule epsilon_rule(const std::string& word, double& value) {
    const char* const words[]{"knn", "volume", "knee", "silhouette", "nested"};
    if (const auto matching_word = std::find(std::begin(words), std::end(words), word); matching_word != std::end(words))
        return static_cast<EpsilonRule>(matching_word - std::begin(words));
    double number = 0;
    const char* end = word.data() + word.size();
    const auto parsed = std::from_chars(word.data(), end, number);
    if (parsed.ec != std::errc() || parsed.ptr != end || !(number >= 0))
        fail_usage(fmt::format("epsilon '{}' is neither a number nor a rule", word),
                   "give a number from 0 up, or knn, volume, knee, silhouette or nested");
    value = number;
    return EpsilonRule::number;
}

}  // namespace

void GroupOptions::declare_options(OptionList& list) {
    list("method", method,
         "clustering method: average linkage cut at epsilon (linkage), DBSCAN with radius epsilon (dbscan), or DBSCAN in the "
         "spectral embedding of the thesis, section 3.3.2 (embedding)",
         Choices{"linkage", "dbscan", "embedding"});
    list("epsilon", epsilon,
         "maximum distance between neighbours in a group (for embedding a share of the largest distance), or a rule that chooses "
         "it: knn (mean distance to the nearest neighbours), volume (spacing of evenly distributed points), knee (bend of the "
         "sorted nearest distances), silhouette (largest mean silhouette) or nested (groups of largest silhouette, divided "
         "further while their parts are distinct)",
         Words{{"knn", "volume", "knee", "silhouette", "nested"}, "a number from 0 up", [](const std::string& word) {
                   double number = 0;
                   static_cast<void>(epsilon_rule(word, number));
               }});
    list("expected-size", expected_size, "expected number of heads per mould, for knn; 0: square root of the number of heads",
         Range{0, 1e9});
    list("dimensions", dimensions, "number of eigenvectors of the spectral embedding", Range{1, 20});
}

MouldGroups group_heads(const Eigen::MatrixXd& distances, const GroupOptions& options) {
    check_options(options, "groups");
    MouldGroups groups;
    const auto embedding = spectral_embedding(distances, options.dimensions);
    groups.coordinates = embedding.coordinates;
    Eigen::MatrixXd embedded_distances = distance_matrix(groups.coordinates);
    if (embedded_distances.maxCoeff() > 0) {
        groups.coordinates /= embedded_distances.maxCoeff();
        embedded_distances /= embedded_distances.maxCoeff();
    }
    const Eigen::MatrixXd& d = options.method == GroupOptions::Method::embedding ? embedded_distances : distances;
    const Grouping grouping(d, options);
    const EpsilonRule rule = epsilon_rule(options.epsilon, groups.epsilon);
    const int expected = options.expected_size > 0 ? options.expected_size - 1
                                                   : static_cast<int>(std::lround(std::sqrt(static_cast<double>(d.rows()))));
    if (rule == EpsilonRule::knn) groups.epsilon = knn_epsilon(d, expected);
    else if (rule == EpsilonRule::volume) groups.epsilon = volume_epsilon(groups.coordinates, 1);
    else if (rule == EpsilonRule::knee) groups.epsilon = knee_epsilon(d);
    else if (rule != EpsilonRule::number) groups.epsilon = grouping.best_epsilon().first;
    groups.tree = grouping.tree();
    std::vector<int> labels = grouping.at(groups.epsilon);
    groups.silhouette = mean(silhouettes_of_distances(d, by_size(labels)));
    groups.clear = groups.silhouette >= (options.method == GroupOptions::Method::embedding ? min_silhouette_in_embedding
                                                                                           : min_silhouette_in_distances);
    if (rule == EpsilonRule::nested && groups.clear) {
        std::vector<std::size_t> all_heads(labels.size());
        std::iota(all_heads.begin(), all_heads.end(), std::size_t{0});
        int next = 0;
        groups.epsilon = nested_groups(d, distances, options, all_heads, labels, next);
        groups.silhouette = mean(silhouettes_of_distances(d, labels));
    } else if ((rule == EpsilonRule::silhouette || rule == EpsilonRule::nested) && !groups.clear) {
        groups.epsilon = grouping.top();
        labels.assign(labels.size(), 0);
    }
    groups.labels = by_size(labels);
    groups.head_silhouettes = silhouettes_of_distances(d, groups.labels);
    return groups;
}

std::vector<ClusterStability> group_stability(const Eigen::MatrixXd& distances, const MouldGroups& groups,
                                              const GroupOptions& options, const StabilityOptions& stability) {
    const auto regroup = [&](const std::vector<std::size_t>& heads) {
        return group_heads(submatrix(distances, heads), options).labels;
    };
    return cluster_stability(groups.labels, regroup, stability);
}

std::vector<double> relative_sizes(const MouldMatrices& matrices, const std::vector<int>& labels) {
    if (static_cast<Eigen::Index>(labels.size()) != matrices.scale.rows())
        fail_usage(fmt::format("{} labels for {} heads", labels.size(), matrices.scale.rows()), "give one label per head");
    std::vector<double> sizes(labels.size(), 1);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        double sum = 0;
        int count = 0;
        for (std::size_t j = 0; j < labels.size(); ++j) {
            if (labels[j] != labels[i]) continue;
            sum += std::log(matrices.scale(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)));
            ++count;
        }
        sizes[i] = std::exp(sum / count);
    }
    return sizes;
}

}  // namespace ostraka
