// Mean shape and principal modes of variation of shapes in correspondence (Cootes et al. 1995; Dryden and Mardia 2016).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

struct ModeOptions {
    bool sizes = false;     ///< true: size is part of the shape
    int maximum = 1000;     ///< max number of modes
    double variance = 1.0;  ///< the first modes are kept that together explain this share of the variance

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Mean shape and modes of variation.
struct ShapeModes {
    bool sizes = false;  ///< true: size is part of the shape
    /// Mean shape, centred at the origin, oriented as the template, with the mean centroid size of the members.
    Landmarks mean;
    Eigen::MatrixXd modes;               ///< one mode per row: x, y, z of each vertex; rows are orthonormal
    std::vector<double> variances;       ///< variance of each mode, divisor n - 1, in the squared unit
    double total = 0;                    ///< total variance of all modes, including modes that were dropped
    Eigen::MatrixXd coefficients;        ///< one row per member, one column per mode
    std::vector<double> centroid_sizes;  ///< centroid size of each member
    double mean_size = 0;                ///< mean of the members' centroid sizes
    std::vector<double> distances;       ///< for each member, the distance from the mean, relative to the mean size
    /// Leave-one-out values of each member: its distance from the mean of the other members, and the component of this distance
    /// outside the span of the other members' modes. Empty for a single member.
    std::vector<double> left_out_distances, left_out_outside;
    std::size_t archetype = 0;  ///< index of the member nearest to the mean
};

/// Generalised Procrustes analysis of the members' vertices with equal weights; without `sizes` all members are scaled to the
/// mean centroid size. The modes are the eigenvectors of the covariance, computed from the n x n matrix of inner products (n
/// members): O(n^2 V + n^3). The mean is rotated onto `frame`, the template's vertices. Leave-one-out values are computed without
/// repeating the alignment. Throws the Errors (input) of generalised_procrustes.
ShapeModes learn_modes(const std::vector<Landmarks>& members, const Landmarks& frame, const ModeOptions& options = {});

/// Coordinates of a shape in the space of the modes.
struct ShapeCoordinates {
    SimilarityMap map;                 ///< maps the shape onto the mean
    std::vector<double> coefficients;  ///< coefficient of each mode
    double distance = 0;               ///< distance from the mean, relative to the mean size
    double outside = 0;                ///< component of the distance from the mean that is outside the span of the modes
    double mahalanobis = 0;    ///< root of the sum of squared coefficients, each divided by the standard deviation of its mode
    double centroid_size = 0;  ///< centroid size of the shape
};
/// Registers a shape to the mean and computes its coordinates.
ShapeCoordinates coordinates_in(const ShapeModes& modes, const Landmarks& shape);

/// The shape with these coefficients: the mean plus the modes times the coefficients.
Landmarks shape_of(const ShapeModes& modes, const std::vector<double>& coefficients);

}  // namespace ostraka
