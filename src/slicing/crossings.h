// Contours that cross one another, or themselves.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

struct Crossings {
    double doubtful = 0;          ///< as in Completeness
    std::vector<bool> cancelled;  ///< of each contour: it lies along another one that runs the other way round
};

/// Sets `crosses` of the closed contours, which stand in front. Contours that only touch (within `tolerance`, a length) do not
/// cross, whatever they share; two that lie along one another in the same sense count as crossing. Edges are compared with those
/// of their strip (strips.h) whose boxes overlap theirs.
Crossings find_crossings(std::vector<Contour>& contours, double tolerance);

}  // namespace ostraka::detail
