// Slices across a curve, for example a skeleton.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

struct CurveSlices {
    std::vector<SliceFrame> frames;  ///< origin on the curve, normal along it; rotation-minimising u
    std::vector<Slice> slices;       ///< at height 0 of their frames; `height` is the arc length
    double length = 0;               ///< length of the curve
    bool reversed = false;           ///< as in SliceStack
};

/// Slices across the curve at the midpoints of `count` pieces of equal length. The tangent is the direction of the chord that
/// reaches one piece to each side. In each plane only the component of the curve is kept: the smallest component around the
/// curve, otherwise the component of the nearest contour (an open contour alone). Each plane searches only the faces near it:
/// O(n log n) once, then about linear in the number of pieces, in parallel. Throws Error (usage) for a curve without length or
/// a count below 1 or above a million, and the errors of slice_mesh.
CurveSlices slice_along(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces = {});

}  // namespace ostraka
