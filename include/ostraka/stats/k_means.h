// Samples put into k groups, and how many groups there may be.
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <vector>

namespace ostraka {

struct KMeansOptions {
    int clusters = 3;
    int restarts = 20;     ///< beginnings, of which the one with the least cost is kept
    int iterations = 300;  ///< at most, of each
    std::uint64_t seed = 1;
    void describe(OptionList& visit);
};

struct KMeansResult {
    std::vector<int> labels;  ///< a cluster a sample; by falling number of samples, equal ones by their first sample
    Eigen::MatrixXd centres;  ///< a row a cluster; fewer than were asked for where there are fewer distinct samples
    double cost = 0;          ///< sum of squared distances to the centres
    int iterations = 0;       ///< of the restart that was kept
    bool converged = false;   ///< no sample changed its cluster in the last iteration
};

/// k-means (MacQueen 1967; Lloyd's iterations) of the rows of `samples`, begun by k-means++ (Arthur and Vassilvitskii 2007). A
/// cluster that loses all samples is given the one farthest from its centre. Columns are taken as they are: see `standardised`.
/// Restarts run in parallel; the result is the same for any number of threads. Throws Error (input) for no sample or one that is
/// not finite, Error (usage) for options out of range.
KMeansResult k_means(const Eigen::MatrixXd& samples, const KMeansOptions& options = {});

/// Each column with mean 0 and deviation 1 (n - 1); columns whose values are all the same become 0. Throws as above.
Eigen::MatrixXd standardised(const Eigen::MatrixXd& samples);

/// Silhouettes (Rousseeuw 1987): (b - a) / max(a, b) of each sample, with a the mean distance to the others of its cluster and b
/// that to the nearest other cluster; 0 for a sample alone in its cluster, for noise (labels below 0) and where there is one
/// cluster only. Quadratic in the number of samples. Throws as above, and Error (usage) unless there is one label a sample.
std::vector<double> silhouettes_of_samples(const Eigen::MatrixXd& samples, const std::vector<int>& labels);
/// The same from a symmetric matrix of distances.
std::vector<double> silhouettes_of_distances(const Eigen::MatrixXd& distances, const std::vector<int>& labels);

struct ClusterCountOptions {
    int max_clusters = 10;
    enum class Criterion { silhouette, gap } criterion = Criterion::silhouette;
    int references = 50;
    KMeansOptions k_means = {};  ///< its number of clusters is not used
    void describe(OptionList& visit);
};

struct ClusterCount {
    struct Row {
        int clusters = 0;
        double cost = 0;        ///< of k-means
        double silhouette = 0;  ///< mean over the samples; 0 for one cluster
        double gap = 0;         ///< expected logarithm of the cost without clusters, less that found
        double gap_error = 0;   ///< its standard error, s_k of the paper
    };
    std::vector<Row> rows;  ///< 1, 2, ... clusters
    int by_silhouette = 1;  ///< the number with the largest mean silhouette, from 2 up; 1 where no more can be tried
    int by_gap = 1;         ///< the least k with gap(k) >= gap(k + 1) - s(k + 1); the last one tried if there is none
    int proposed = 1;       ///< by the criterion of the options
};

/// Tries 1 to `max_clusters` clusters; never more than there are distinct samples, and as many as there are only where each is
/// there twice on average. The silhouette cannot propose 1; the gap statistic (Tibshirani, Walther and Hastie 2001, references
/// drawn evenly from the box along the principal directions, version b) can. Costs below 1e-24 of that of one cluster count as
/// that. Throws as k_means.
ClusterCount propose_cluster_count(const Eigen::MatrixXd& samples, const ClusterCountOptions& options = {});

}  // namespace ostraka
