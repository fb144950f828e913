// Clustering by distances: DBSCAN and hierarchical linkage.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// DBSCAN clustering (Ester, Kriegel, Sander and Xu 1996) of the rows of `samples`. A sample with at least `minimum` samples
/// (including itself) at distances of at most `epsilon` is a core point. Returns one label per sample: 0, 1, ... in the order of
/// the clusters' first core points, and -1 for noise; a border point within `epsilon` of two clusters belongs to the first of
/// them. With minimum 1 there is no noise, and clusters are the sets of samples connected by steps of `epsilon`. Time:
/// quadratic in the number of samples. Throws Error (input) for no sample and values that are not finite, and Error (usage) for
/// an epsilon below 0 or a minimum below 1.
std::vector<int> dbscan(const Eigen::MatrixXd& samples, double epsilon, int minimum);

/// Radius `epsilon` for DBSCAN: the radius within which a sample would have `minimum` samples on average, if the samples were
/// distributed uniformly over their bounding box (Daszykowski, Walczak and Massart 2001). Columns without extent are ignored; 0
/// if no column has an extent. Throws the errors of dbscan.
double volume_epsilon(const Eigen::MatrixXd& samples, int minimum);

/// Symmetric matrix of the distances between all pairs of rows. Throws the errors of dbscan.
Eigen::MatrixXd distance_matrix(const Eigen::MatrixXd& samples);

/// A merge of two clusters. Samples are the clusters 0 to n - 1; merge i creates the cluster n + i.
struct Merge {
    int first = 0, second = 0;  ///< indices of the merged clusters, first < second
    double height = 0;          ///< distance of the two clusters
    int size = 0;               ///< number of samples in the new cluster
};

/// A tree of clusters: n - 1 merges by increasing height.
struct Linkage {
    int samples = 0;            ///< number of samples
    std::vector<Merge> merges;  ///< merges by increasing height
};

/// Definition of the distance of two clusters: the mean (average; UPGMA, Sokal and Michener 1958), minimum (single) or maximum
/// (complete) of the distances between their members.
enum class LinkageMethod { average, single, complete };
/// Hierarchical clustering by nearest-neighbour chains (Murtagh 1983), quadratic in the number of samples. Throws Error (input)
/// for a matrix that is not symmetric, not finite or has negative entries.
Linkage linkage(const Eigen::MatrixXd& distances, LinkageMethod method = LinkageMethod::average);

/// For each sample, the label of its cluster after all merges up to `height`; labels are numbered by the clusters' first samples.
std::vector<int> cut_at(const Linkage& tree, double height);
/// The samples in the order of the tree's leaves, in which the lines of a dendrogram do not cross.
std::vector<int> leaf_order(const Linkage& tree);

}  // namespace ostraka
