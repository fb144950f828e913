// Samples grouped by their distances: DBSCAN, and trees of average linkage.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// DBSCAN (Ester, Kriegel, Sander and Xu 1996) of the rows of `samples`. A sample with at least `minimum` samples (itself
/// counted) at distances of at most `epsilon` is in the inside of a cluster. Returns a label a sample: 0, 1, ... in the order of
/// the clusters' first inner samples, and -1 for noise; a sample on the rim of two clusters belongs to the first. With minimum 1
/// there is no noise, and clusters are what steps of `epsilon` connect. Quadratic in the number of samples. Throws Error (input)
/// for no sample, values that are not finite, a matrix that is not symmetric or negative, and Error (usage) for an epsilon below
/// 0 or a minimum below 1.
std::vector<int> dbscan(const Eigen::MatrixXd& samples, double epsilon, int minimum);

/// The radius at which as many samples, spread evenly over the box that holds them, would have `minimum` of them within reach
/// (Daszykowski, Walczak and Massart 2001). Columns without extent do not count; 0 where none has any. Throws as above.
double volume_epsilon(const Eigen::MatrixXd& samples, int minimum);

/// Distances between all pairs of rows. Throws as above.
Eigen::MatrixXd distance_matrix(const Eigen::MatrixXd& samples);

/// Two clusters that become one. Samples are 0 to n - 1, the cluster of merge i is n + i.
struct Merge {
    int first = 0, second = 0;  ///< first < second
    double height = 0;          ///< their distance
    int size = 0;               ///< samples of the new cluster
};

/// A tree of clusters: n - 1 merges by rising height.
struct Linkage {
    int samples = 0;
    std::vector<Merge> merges;
};

/// Average linkage (UPGMA, Sokal and Michener 1958) by chains of nearest neighbours (Murtagh 1983): quadratic in the number of
/// samples. `method`: by the mean, the least or the largest distance between members. Throws as above.
enum class LinkageMethod { average, single, complete };
Linkage linkage(const Eigen::MatrixXd& distances, LinkageMethod method = LinkageMethod::average);

/// Labels of the clusters that merges up to `height` make, numbered by their first samples.
std::vector<int> cut_at(const Linkage& tree, double height);
/// The samples in the order of the tree's leaves, so that no lines of a drawing cross.
std::vector<int> leaf_order(const Linkage& tree);

}  // namespace ostraka
