// Mean shape and principal modes of variation of shapes in correspondence (Cootes et al. 1995; Dryden and Mardia 2016).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/registration/procrustes.h"

namespace ostraka {

struct ModeOptions {
    bool sizes = false;     ///< sizes count: they are part of the shape
    int maximum = 1000;     ///< modes kept
    double variance = 1.0;  ///< modes are kept until they have this share of the variance

    void describe(OptionList& visit);
};

struct ShapeModes {
    bool sizes = false;
    Landmarks mean;                      ///< about the origin, turned as the frame; of the members' mean centroid size
    Eigen::MatrixXd modes;               ///< a mode a row: x, y, z of each vertex; rows are orthonormal
    std::vector<double> variances;       ///< of each mode, n - 1 below the line, in the unit squared
    double total = 0;                    ///< variance of all modes there are
    Eigen::MatrixXd coefficients;        ///< of the members, a row each
    std::vector<double> centroid_sizes;  ///< of the members
    double mean_size = 0;
    std::vector<double> distances;  ///< of each member from the mean, as a share of the mean size
    /// Of each member from the mean of the others, and what of that no combination of the others' modes gives. Empty for one.
    std::vector<double> left_out_distances, left_out_outside;
    std::size_t archetype = 0;  ///< the member nearest the mean
};

/// Generalised Procrustes over the members' vertices, all weighing the same; without `sizes` all are brought to the mean centroid
/// size. Modes are the eigenvectors of the covariance, found from the n x n matrix of inner products (n members): O(n^2 V + n^3).
/// The mean is turned onto `frame`. Members are not aligned anew when one is left out. Throws Error (input) as
/// generalised_procrustes does.
ShapeModes learn_modes(const std::vector<Landmarks>& members, const Landmarks& frame, const ModeOptions& options = {});

/// A shape as the modes see it.
struct ShapeCoordinates {
    SimilarityMap map;  ///< from the shape to where the mean is
    std::vector<double> coefficients;
    double distance = 0;     ///< from the mean, as a share of the mean size
    double outside = 0;      ///< what the modes do not give of it
    double mahalanobis = 0;  ///< root of the sum of squared coefficients, each over the mode's deviation
    double centroid_size = 0;
};
ShapeCoordinates coordinates_in(const ShapeModes& modes, const Landmarks& shape);

/// Mean plus modes times coefficients.
Landmarks shape_of(const ShapeModes& modes, const std::vector<double>& coefficients);

}  // namespace ostraka
