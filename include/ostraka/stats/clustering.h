// Clustering by distances: DBSCAN and hierarchical linkage.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// DBSCAN (Ester, Kriegel, Sander and Xu 1996) of the rows of `samples`. A sample with at least `minimum` samples (including
/// itself) at distances of at most `epsilon` is a core point. Returns one label per sample: 0, 1, ... in the order of the
/// clusters' first core points, and -1 for noise; a border point of two clusters belongs to the first. With minimum 1 there is
/// no noise, and clusters are the sets connected by steps of `epsilon`. Quadratic in the number of samples. Throws Error
/// (input) for no sample, values that are not finite, a matrix that is not symmetric or negative, and Error (usage) for an
/// epsilon below 0 or a minimum below 1.
std::vector<int> dbscan(const Eigen::MatrixXd& samples, double epsilon, int minimum);

/// The radius within which the same number of samples, distributed uniformly over their bounding box, would have `minimum`
/// samples on average (Daszykowski, Walczak and Massart 2001). Columns without extent are ignored; 0 if no column has one.
/// Throws the same errors.
double volume_epsilon(const Eigen::MatrixXd& samples, int minimum);

/// Distances between all pairs of rows. Throws the same errors.
Eigen::MatrixXd distance_matrix(const Eigen::MatrixXd& samples);

/// A merge of two clusters. Samples are numbered 0 to n - 1; the cluster of merge i is n + i.
struct Merge {
    int first = 0, second = 0;  ///< first < second
    double height = 0;          ///< distance of the two clusters
    int size = 0;               ///< number of samples in the new cluster
};

/// A tree of clusters: n - 1 merges by increasing height.
struct Linkage {
    int samples = 0;
    std::vector<Merge> merges;
};

/// Hierarchical clustering by nearest-neighbour chains (Murtagh 1983), quadratic in the number of samples. `method`: mean
/// (UPGMA, Sokal and Michener 1958), minimum or maximum distance between members. Throws the same errors.
enum class LinkageMethod { average, single, complete };
Linkage linkage(const Eigen::MatrixXd& distances, LinkageMethod method = LinkageMethod::average);

/// Labels of the clusters formed by the merges up to `height`, numbered by their first samples.
std::vector<int> cut_at(const Linkage& tree, double height);
/// The samples in the order of the tree's leaves, so that the lines of a dendrogram do not cross.
std::vector<int> leaf_order(const Linkage& tree);

}  // namespace ostraka
