// Mean shape and principal modes of variation of shapes in correspondence (Cootes et al. 1995; Dryden and Mardia 2016).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

struct ModeOptions {
    bool sizes = false;     ///< whether size is part of the shape
    int maximum = 1000;     ///< maximum number of modes
    double variance = 1.0;  ///< modes are kept up to this share of the variance

    void list_options(OptionList& list);
};

struct ShapeModes {
    bool sizes = false;
    Landmarks mean;                      ///< centred at the origin, oriented as the frame, with the members' mean centroid size
    Eigen::MatrixXd modes;               ///< one mode per row: x, y, z of each vertex; rows are orthonormal
    std::vector<double> variances;       ///< one per mode, divisor n - 1, in the squared unit
    double total = 0;                    ///< total variance of all modes, kept or not
    Eigen::MatrixXd coefficients;        ///< one row per member
    std::vector<double> centroid_sizes;  ///< one per member
    double mean_size = 0;
    std::vector<double> distances;  ///< one per member: distance from the mean, relative to the mean size
    /// One per member: distance from the mean of the others, and the part of it outside the span of the others' modes. Empty
    /// for a single member.
    std::vector<double> left_out_distances, left_out_outside;
    std::size_t archetype = 0;  ///< index of the member nearest to the mean
};

/// Generalised Procrustes analysis of the members' vertices with equal weights; without `sizes` all members are scaled to the
/// mean centroid size. The modes are the eigenvectors of the covariance, computed from the n x n matrix of inner products (n
/// members): O(n^2 V + n^3). The mean is rotated onto `frame`. Leave-one-out values do not repeat the alignment. Throws the
/// Errors (input) of generalised_procrustes.
ShapeModes learn_modes(const std::vector<Landmarks>& members, const Landmarks& frame, const ModeOptions& options = {});

/// Coordinates of a shape in the space of the modes.
struct ShapeCoordinates {
    SimilarityMap map;  ///< from the shape to the frame of the mean
    std::vector<double> coefficients;
    double distance = 0;     ///< distance from the mean, relative to the mean size
    double outside = 0;      ///< part of the distance outside the span of the modes
    double mahalanobis = 0;  ///< root of the sum of squared coefficients, each divided by the standard deviation of its mode
    double centroid_size = 0;
};
ShapeCoordinates coordinates_in(const ShapeModes& modes, const Landmarks& shape);

/// The mean plus the modes times the coefficients.
Landmarks shape_of(const ShapeModes& modes, const std::vector<double>& coefficients);

}  // namespace ostraka
