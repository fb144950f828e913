// Superimposes landmark configurations (Procrustes analysis; Gower 1975, Dryden and Mardia 2016).
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
    double sum_of_squares = 0;  ///< residual between the mapped landmarks and their targets
    [[nodiscard]] Landmarks apply(const Landmarks& landmarks) const;
};

struct ProcrustesOptions {
    bool scaling = false;
    bool reflection = false;
    void describe(OptionList& visit);
};

/// The rotation and translation, and with `scaling` the scale, that map `from` nearest to `to` in the least-squares sense, by
/// the singular value decomposition (Umeyama 1991). Throws Error (input) unless both have the same number of landmarks, at
/// least three, all finite; and for a configuration whose landmarks all coincide. Collinear landmarks do not determine the
/// rotation about their line: an arbitrary optimal one is returned.
SimilarityMap procrustes(const Landmarks& from, const Landmarks& to, const ProcrustesOptions& options = {});

struct GeneralisedProcrustes {
    std::vector<Landmarks> aligned;   ///< centred and rotated; of centroid size 1 with `scaling`
    std::vector<SimilarityMap> maps;  ///< maps to the aligned configurations; their sums of squares are those to the mean
    /// Mean of the aligned configurations, in the orientation of the first one; with `scaling` normalised to centroid size 1.
    Landmarks mean;
    std::vector<double> centroid_sizes;
    double sum_of_squares = 0;  ///< sum over all aligned configurations about the mean
    int iterations = 0;
    bool converged = false;  ///< the sum of squares fell by less than 1e-15 of the squared sizes
};

/// Generalised Procrustes analysis (Gower 1975): centres all configurations and rotates each in turn to their common mean.
/// Without `scaling` sizes are kept (partial, size-and-shape); with it all have centroid size 1 (shape). Throws Error (input)
/// for no configuration, and as `procrustes`. O(iterations n k).
GeneralisedProcrustes generalised_procrustes(const std::vector<Landmarks>& configurations, const ProcrustesOptions& options = {});

/// Configurations as rows of a matrix: x, y, z of the first landmark, then of the second ..., as for principal component
/// analysis.
Eigen::MatrixXd shape_rows(const std::vector<Landmarks>& configurations);

}  // namespace ostraka
