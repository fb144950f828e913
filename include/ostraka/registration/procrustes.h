// Configurations of landmarks superimposed (Procrustes analysis; Gower 1975, Dryden and Mardia 2016).
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// k landmarks as rows x, y, z.
using Landmarks = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Root of the sum of squared distances from the centroid.
double centroid_size(const Landmarks& landmarks);

/// x -> scale * rotation * x + translation.
struct SimilarityMap {
    double scale = 1;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    double sum_of_squares = 0;  ///< what is left between the moved landmarks and their goals
    [[nodiscard]] Landmarks apply(const Landmarks& landmarks) const;
};

struct ProcrustesOptions {
    bool scaling = false;
    bool reflection = false;
    void describe(OptionList& visit);
};

/// The rotation and translation, and with `scaling` the scale, that bring `from` nearest to `to` in the sum of squares, by the
/// singular value decomposition (Umeyama 1991). Throws Error (input) unless both have the same number of landmarks, at least
/// three, all finite; and for a configuration whose landmarks are all in one place. Landmarks on one line leave the turn about it
/// open: any that is best may come.
SimilarityMap procrustes(const Landmarks& from, const Landmarks& to, const ProcrustesOptions& options = {});

struct GeneralisedProcrustes {
    std::vector<Landmarks> aligned;   ///< about their centroids, turned; of centroid size 1 with `scaling`
    std::vector<SimilarityMap> maps;  ///< that lead there; their sums of squares are those to the mean
    /// Of the aligned configurations, in the orientation of the first one; with `scaling` brought to centroid size 1 itself.
    Landmarks mean;
    std::vector<double> centroid_sizes;
    double sum_of_squares = 0;  ///< of all aligned configurations about the mean
    int iterations = 0;
    bool converged = false;  ///< the sum of squares fell by less than 1e-15 of the squared sizes
};

/// Generalised Procrustes analysis (Gower 1975): all configurations about their centroids, turned to their common mean by turns.
/// Without `scaling` sizes stay (partial, size-and-shape); with it all have centroid size 1 (shape). Throws Error (input) for no
/// configuration, and as `procrustes`. O(iterations n k).
GeneralisedProcrustes generalised_procrustes(const std::vector<Landmarks>& configurations, const ProcrustesOptions& options = {});

/// Configurations as rows of a matrix: x, y, z of the first landmark, then of the second ..., as principal components need them.
Eigen::MatrixXd shape_rows(const std::vector<Landmarks>& configurations);

}  // namespace ostraka
