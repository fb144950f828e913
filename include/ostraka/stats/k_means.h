// k-means clustering, and the choice of the number of clusters.
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <vector>

namespace ostraka {

struct KMeansOptions {
    int clusters = 3;
    int restarts = 20;     ///< number of initialisations; the cheapest result is kept
    int iterations = 300;  ///< maximum per initialisation
    std::uint64_t seed = 1;
    void list_options(OptionList& list);
};

struct KMeansResult {
    std::vector<int> labels;  ///< one per sample; clusters by decreasing size, ties by their first sample
    Eigen::MatrixXd centres;  ///< one row per cluster; fewer than requested if there are fewer distinct samples
    double cost = 0;          ///< sum of squared distances to the centres
    int iterations = 0;       ///< iterations of the kept restart
    bool converged = false;   ///< whether no label changed in the last iteration
};

/// k-means (MacQueen 1967; Lloyd's iterations) of the rows of `samples`, initialised by k-means++ (Arthur and Vassilvitskii
/// 2007). A cluster that loses all samples is assigned the sample farthest from its centre. Columns are not scaled: see
/// `standardised`. Restarts run in parallel; the result does not depend on the number of threads. Throws Error (input) for no
/// sample or one that is not finite, Error (usage) for options out of range.
KMeansResult k_means(const Eigen::MatrixXd& samples, const KMeansOptions& options = {});

/// Scales each column to mean 0 and standard deviation 1 (divisor n - 1); constant columns become 0. Throws the same errors.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& samples);

/// Silhouettes (Rousseeuw 1987): (b - a) / max(a, b) of each sample, where a is the mean distance to the other samples of its
/// cluster and b that to the nearest other cluster; 0 for a single-sample cluster, for noise (labels below 0) and if there is
/// only one cluster. Quadratic in the number of samples. Throws the same errors, and Error (usage) unless there is one label
/// per sample.
std::vector<double> silhouettes_of_samples(const Eigen::MatrixXd& samples, const std::vector<int>& labels);
/// The same from a symmetric matrix of distances.
std::vector<double> silhouettes_of_distances(const Eigen::MatrixXd& distances, const std::vector<int>& labels);

struct ClusterCountOptions {
    int max_clusters = 10;
    enum class Criterion { silhouette, gap } criterion = Criterion::silhouette;
    int references = 50;
    KMeansOptions k_means = {};  ///< its number of clusters is ignored
    void list_options(OptionList& list);
};

struct ClusterCount {
    struct Row {
        int clusters = 0;
        double cost = 0;        ///< k-means cost
        double silhouette = 0;  ///< mean over the samples; 0 for one cluster
        double gap = 0;         ///< expected logarithm of the cost without clusters minus the observed one
        double gap_error = 0;   ///< its standard error, s_k of the paper
    };
    std::vector<Row> rows;  ///< 1, 2, ... clusters
    int by_silhouette = 1;  ///< the number, from 2 up, with the largest mean silhouette; 1 if no larger number can be tried
    int by_gap = 1;         ///< the smallest k with gap(k) >= gap(k + 1) - s(k + 1); the last one tried if there is none
    int proposed = 1;       ///< number proposed by the criterion in the options
};

/// Tries 1 to `max_clusters` clusters, at most the number of distinct samples (and exactly that number only if each distinct
/// sample occurs twice on average). The silhouette cannot propose 1; the gap statistic can (Tibshirani, Walther and Hastie 2001,
/// version b: references drawn uniformly from the box along the principal directions). Costs below 1e-24 of the cost of one
/// cluster are raised to that value. Throws the errors of k_means.
ClusterCount propose_cluster_count(const Eigen::MatrixXd& samples, const ClusterCountOptions& options = {});

}  // namespace ostraka
