// Superimposes landmark configurations (Procrustes analysis; Gower 1975, Dryden and Mardia 2016).
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// A configuration of k landmarks: k rows x, y, z.
using Landmarks = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Centroid size of a configuration: root of the sum of squared distances of the landmarks from their centroid.
double centroid_size(const Landmarks& landmarks);

/// A similarity transformation: x -> scale * rotation * x + translation.
struct SimilarityMap {
    double scale = 1;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    double sum_of_squares = 0;  ///< sum of the squared distances of the mapped landmarks from their targets
    [[nodiscard]] Landmarks apply(const Landmarks& landmarks) const;  ///< maps each landmark
};

struct ProcrustesOptions {
    bool scaling = false;     ///< true: scale all configurations to the same size
    bool reflection = false;  ///< true: treat mirror images as the same shape
    /// True: rotations are about the z axis only, for two-dimensional landmarks (z is 0), which a half turn in space would
    /// mirror.
    bool planar = false;
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The rotation and translation, and with `scaling` the scale, that map `from` to `to` with the least sum of squared distances,
/// by the singular value decomposition (Umeyama 1991). Throws Error (input) unless both configurations have the same number of
/// landmarks, at least three, all finite, and for a configuration whose landmarks all coincide. Collinear landmarks do not
/// determine the rotation about their line: an arbitrary optimal rotation is returned.
SimilarityMap procrustes(const Landmarks& from, const Landmarks& to, const ProcrustesOptions& options = {});

/// Result of a generalised Procrustes analysis.
struct GeneralisedProcrustes {
    std::vector<Landmarks> aligned;  ///< configurations, centred and rotated; with `scaling` of centroid size 1
    /// For each configuration, the map to its aligned configuration; `sum_of_squares` is relative to the mean.
    std::vector<SimilarityMap> maps;
    /// Mean of the aligned configurations, in the orientation of the first one; with `scaling` normalised to centroid size 1.
    Landmarks mean;
    std::vector<double> centroid_sizes;  ///< centroid size of each given configuration
    double sum_of_squares = 0;           ///< sum of the squared distances of all aligned landmarks from the mean
    int iterations = 0;                  ///< number of iterations
    bool converged = false;  ///< true: the last iteration decreased the sum of squares by less than 1e-15 of the squared sizes
};

/// Generalised Procrustes analysis (Gower 1975): centres all configurations and rotates each in turn to the common mean. Without
/// `scaling` sizes are kept (partial, size-and-shape); with `scaling` all configurations get centroid size 1 (shape). Throws
/// Error (input) if there is no configuration, and as `procrustes`. Time: O(iterations n k).
GeneralisedProcrustes generalised_procrustes(const std::vector<Landmarks>& configurations, const ProcrustesOptions& options = {});

/// Whether all landmarks have the z coordinate 0, as two-dimensional landmarks do.
bool are_planar(const std::vector<Landmarks>& configurations);

/// Configurations as rows of a matrix for principal component analysis: each row has x, y, z of the first landmark, then of the
/// second ...
Eigen::MatrixXd shape_rows(const std::vector<Landmarks>& configurations);

}  // namespace ostraka
