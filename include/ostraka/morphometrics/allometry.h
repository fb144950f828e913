// Allometry: shape that changes with size (Mitteroecker et al. 2004; Drake and Klingenberg 2008).
#pragma once

#include "ostraka/morphometrics/shape_sample.h"

namespace ostraka {

/// Regression of shape on the logarithm of centroid size.
struct Allometry {
    Landmarks slope;                   ///< change of the aligned landmarks per unit of log centroid size
    double share = 0;                  ///< share of the variation of shape that size explains
    std::vector<double> log_sizes;     ///< natural logarithm of the centroid size of each specimen
    std::vector<double> scores;        ///< regression score of each specimen: deviation from the mean along the slope
    std::vector<double> predicted;     ///< the same for the predicted shapes
    Landmarks smallest, largest;       ///< predicted shapes at the smallest and the largest size
    std::vector<Landmarks> residuals;  ///< mean shape plus residuals: shapes corrected for size
};

/// Allometry of superimposed configurations of size 1; with `groups` (one label per specimen) the slope is that within groups,
/// pooled. Throws Error (input) unless there are three specimens, and sizes differ.
Allometry allometry(const GeneralisedProcrustes& aligned, const std::vector<std::string>& groups = {});

}  // namespace ostraka
