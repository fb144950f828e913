// k-means clustering, and the choice of the number of clusters.
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <vector>

namespace ostraka {

struct KMeansOptions {
    int clusters = 3;                        ///< number of clusters
    int restarts = 20;                       ///< number of initialisations; the result of lowest cost is kept
    int iterations = 300;                    ///< max number of iterations per initialisation
    std::uint64_t seed = 1;                  ///< random seed
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Result of k-means clustering.
struct KMeansResult {
    /// For each sample, the index of its cluster. Clusters are numbered by decreasing size, and clusters of equal size by their
    /// first sample.
    std::vector<int> labels;
    Eigen::MatrixXd centres;  ///< one row per cluster; fewer than requested if there are fewer distinct samples
    double cost = 0;          ///< sum of the squared distances of the samples from their cluster's centre
    int iterations = 0;       ///< number of iterations of the initialisation that was kept
    bool converged = false;   ///< true: no label changed in the last iteration
};

/// k-means clustering (MacQueen 1967; Lloyd's iterations) of the rows of `samples`, initialised by k-means++ (Arthur and
/// Vassilvitskii 2007). A cluster that loses all its samples gets the sample that is farthest from its current centre. Columns
/// are not scaled; use `standardised` to scale them. Initialisations run in parallel; the result does not depend on the number
/// of threads. Throws Error (input) for no sample or a sample that is not finite, Error (usage) for options out of range.
KMeansResult k_means(const Eigen::MatrixXd& samples, const KMeansOptions& options = {});

/// Scales each column to mean 0 and standard deviation 1 (divisor n - 1); constant columns become 0. Throws Error (input) for no
/// sample or a sample that is not finite.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& samples);

/// Silhouette of each sample (Rousseeuw 1987): (b - a) / max(a, b), where a is the mean distance to the other samples of its
/// cluster and b the mean distance to the samples of the nearest other cluster; 0 for a cluster of one sample, for noise (labels
/// below 0) and if there is only one cluster. Time: quadratic in the number of samples. Throws Error (input) for no sample or a
/// sample that is not finite, and Error (usage) unless there is one label per sample.
std::vector<double> silhouettes_of_samples(const Eigen::MatrixXd& samples, const std::vector<int>& labels);
/// Silhouette of each sample, from a symmetric matrix of the distances between samples.
std::vector<double> silhouettes_of_distances(const Eigen::MatrixXd& distances, const std::vector<int>& labels);

struct ClusterCountOptions {
    int max_clusters = 10;  ///< max number of clusters that is tried
    /// Criterion that proposes the number of clusters.
    enum class Criterion { silhouette, gap } criterion = Criterion::silhouette;
    int references = 50;                     ///< gap statistic: number of reference data sets
    KMeansOptions k_means = {};              ///< options of k-means; the number of clusters is ignored
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Criteria for each number of clusters, and the proposed numbers.
struct ClusterCount {
    /// Criteria for one number of clusters.
    struct Row {
        int clusters = 0;       ///< number of clusters
        double cost = 0;        ///< k-means cost
        double silhouette = 0;  ///< mean silhouette of the samples; 0 for one cluster
        /// Gap statistic: expected logarithm of the cost for data without clusters, minus the logarithm of the observed cost.
        double gap = 0;
        double gap_error = 0;  ///< standard error of the gap, s_k of the paper
    };
    std::vector<Row> rows;  ///< criteria for 1, 2, ... clusters
    /// The number of clusters, from 2 up, with the largest mean silhouette; 1 if no larger number can be tried.
    int by_silhouette = 1;
    int by_gap = 1;    ///< the smallest number k with gap(k) >= gap(k + 1) - s(k + 1); the largest number tried if there is none
    int proposed = 1;  ///< the number proposed by the criterion in the options
};

/// Evaluates the criteria for 1 to `max_clusters` clusters. The number of clusters stays below the number of distinct samples,
/// or may equal it if each distinct sample occurs twice on average. The silhouette cannot propose one cluster; the gap
/// statistic can (Tibshirani, Walther and Hastie 2001, version b: reference data drawn uniformly from the box along the
/// principal directions). Costs below 1e-24 of the cost of one cluster are raised to that value. Throws the errors of k_means.
ClusterCount propose_cluster_count(const Eigen::MatrixXd& samples, const ClusterCountOptions& options = {});

}  // namespace ostraka
