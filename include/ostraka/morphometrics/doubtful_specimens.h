// Finds specimens whose landmarks were probably recorded wrongly, and the single error that explains each.
#pragma once

#include "ostraka/morphometrics/shape_sample.h"

#include <cstddef>
#include <string>
#include <vector>

namespace ostraka {

/// The error that explains a doubtful specimen.
enum class DoubtCause {
    unexplained,  ///< the shape is an outlier, and no single error explains it
    mirrored,     ///< the mirror image fits: axes were exchanged, or left and right
    exchanged,    ///< the shape fits after two landmarks are exchanged
    displaced     ///< the shape fits without one landmark
};

/// A doubtful specimen.
struct Doubt {
    std::size_t specimen = 0;  ///< index of the specimen
    DoubtCause cause = DoubtCause::unexplained;
    std::vector<std::size_t> landmarks;  ///< the two exchanged landmarks, or the displaced one
    double distance = 0;                 ///< Procrustes distance from the mean of the undoubted other specimens, size 1
    double limit = 0;                    ///< distance from which a specimen of the sample is an outlier
    double corrected = 0;                ///< distance after the error is undone; `distance` if it is unexplained
};

/// Doubtful specimens of a sample of complete configurations, in the order of the sample; none for fewer than five specimens. The
/// reference is the mean of the specimens that are not outliers, found in alternation; each specimen is compared with the mean of
/// the others. A specimen is an outlier if its distance exceeds the upper quartile by more than 1.5 interquartile ranges and 1.3
/// medians. Two landmarks count as exchanged, also where the specimen is no outlier, if both lie more than four times as far from
/// the mean as is usual for these landmarks (upper quartile of the others), and both do not after the exchange, which must at
/// least halve their squared distances to the mean. A specimen counts as mirrored if its mirror image is less than half as far
/// from the mean. Time: O(n k^2) and a Procrustes fit for each of at most twenty exchanges and of k landmarks of an outlier.
std::vector<Doubt> doubtful_specimens(const ShapeSample& sample);

}  // namespace ostraka
