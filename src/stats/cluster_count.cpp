#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/k_means.h"
#include "ostraka/stats/random.h"
#include "stats/check_samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

template <class Distance>
std::vector<double> silhouettes_by(std::size_t n, const std::vector<int>& labels, const Distance& distance) {
    if (labels.size() != n)
        fail_usage(fmt::format("there are {} labels for {} samples", labels.size(), n), "give one label per sample");
    const int maximum = *std::max_element(labels.begin(), labels.end());
    std::vector<std::size_t> sizes(static_cast<std::size_t>(std::max(0, maximum + 1)));
    for (const int label : labels)
        if (label >= 0) ++sizes[static_cast<std::size_t>(label)];
    std::vector<double> result(n, 0.0);
    parallel_for(n, 16, [&](std::size_t i) {
        if (labels[i] < 0 || sizes[static_cast<std::size_t>(labels[i])] < 2) return;
        std::vector<double> distance_sums(sizes.size());
        for (std::size_t j = 0; j < n; ++j)
            if (labels[j] >= 0 && j != i) distance_sums[static_cast<std::size_t>(labels[j])] += distance(i, j);
        const auto own_cluster = static_cast<std::size_t>(labels[i]);
        const double a = distance_sums[own_cluster] / static_cast<double>(sizes[own_cluster] - 1);
        double b = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < sizes.size(); ++k)
            if (k != own_cluster && sizes[k] > 0) b = std::min(b, distance_sums[k] / static_cast<double>(sizes[k]));
        if (std::isfinite(b) && std::max(a, b) > 0) result[i] = (b - a) / std::max(a, b);
    });
    return result;
}

/// Draws the same number of samples uniformly from the box along the principal directions.
Eigen::MatrixXd reference(const Eigen::MatrixXd& rotated, Random random) {
    Eigen::MatrixXd result(rotated.rows(), rotated.cols());
    for (Eigen::Index j = 0; j < rotated.cols(); ++j) {
        const double low = rotated.col(j).minCoeff(), high = rotated.col(j).maxCoeff();
        for (Eigen::Index i = 0; i < rotated.rows(); ++i) result(i, j) = random.uniform(low, high);
    }
    return result;
}

}  // namespace

std::vector<double> silhouettes_of_samples(const Eigen::MatrixXd& samples, const std::vector<int>& labels) {
    require_samples(samples, "silhouettes");
    const Eigen::MatrixXd columns = samples.transpose();
    return silhouettes_by(static_cast<std::size_t>(samples.rows()), labels, [&](std::size_t i, std::size_t j) {
        return (columns.col(static_cast<Eigen::Index>(i)) - columns.col(static_cast<Eigen::Index>(j))).stableNorm();
    });
}

std::vector<double> silhouettes_of_distances(const Eigen::MatrixXd& distances, const std::vector<int>& labels) {
    require_symmetric(distances, true, "silhouettes");
    return silhouettes_by(static_cast<std::size_t>(distances.rows()), labels, [&](std::size_t i, std::size_t j) {
        return distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    });
}

ClusterCount propose_cluster_count(const Eigen::MatrixXd& samples, const ClusterCountOptions& options) {
    check_options(options, "number of clusters");
    require_samples(samples, "number of clusters");
    const std::size_t distinct = distinct_rows(samples);
    const std::size_t max_possible =
        2 * distinct <= static_cast<std::size_t>(samples.rows()) ? distinct : std::max<std::size_t>(1, distinct - 1);
    const int maximum = static_cast<int>(std::min(static_cast<std::size_t>(options.max_clusters), max_possible));

    // Version b of the paper: the box is aligned with the principal directions.
    Eigen::MatrixXd centred = samples.rowwise() - samples.row(0);
    centred.rowwise() -= centred.colwise().mean().eval();
    const double largest = centred.cwiseAbs().maxCoeff();
    if (!std::isfinite(largest)) fail_input("number of clusters", "the range of the values is too large", "use another unit");
    if (largest > 0) centred /= largest;
    const SymmetricEigenX principal(centred.transpose() * centred);
    const Eigen::MatrixXd rotated = centred * principal.eigenvectors();
    const double total_cost = centred.squaredNorm(), minimum = 1e-24 * (total_cost > 0 ? total_cost : 1);

    ClusterCount result;
    double best = -std::numeric_limits<double>::infinity();
    for (int k = 1; k <= maximum; ++k) {
        KMeansOptions options_for_k = options.k_means;
        options_for_k.clusters = k;
        const KMeansResult clustering = k_means(centred, options_for_k);
        ClusterCount::Row row;
        row.clusters = k;
        row.cost = largest > 0 ? clustering.cost * largest * largest : 0;
        if (k > 1) {
            for (const double s : silhouettes_of_samples(centred, clustering.labels))
                row.silhouette += s / static_cast<double>(samples.rows());
            if (row.silhouette > best) best = row.silhouette, result.by_silhouette = k;
        }
        std::vector<double> logs(static_cast<std::size_t>(options.references));
        parallel_for(logs.size(), 1, [&](std::size_t b) {
            logs[b] =
                std::log(std::max(minimum, k_means(reference(rotated, Random(options.k_means.seed, b + 1)), options_for_k).cost));
        });
        double mean = 0, square = 0;
        for (const double value : logs) mean += value / static_cast<double>(logs.size());
        for (const double value : logs) square += (value - mean) * (value - mean) / static_cast<double>(logs.size());
        row.gap = mean - std::log(std::max(minimum, clustering.cost));
        row.gap_error = std::sqrt(square * (1 + 1 / static_cast<double>(logs.size())));
        result.rows.push_back(row);
    }
    result.by_gap = maximum;
    for (std::size_t k = 0; k + 1 < result.rows.size(); ++k)
        if (result.rows[k].gap >= result.rows[k + 1].gap - result.rows[k + 1].gap_error) {
            result.by_gap = result.rows[k].clusters;
            break;
        }
    result.proposed = options.criterion == ClusterCountOptions::Criterion::gap ? result.by_gap : result.by_silhouette;
    return result;
}

}  // namespace ostraka
