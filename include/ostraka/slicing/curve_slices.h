// Slices across a curve: a skeleton, say.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

struct CurveSlices {
    std::vector<SliceFrame> frames;  ///< origin on the curve, normal along it; u turns as little as can be from one to the next
    std::vector<Slice> slices;       ///< at height 0 of their frames; `height` is the length of the curve up to there
    double length = 0;               ///< of the curve
    bool reversed = false;           ///< as in SliceStack
};

/// Cuts across the curve at the middles of `count` pieces of even length. The tangent is that of the chord over one piece to each
/// side. Of each plane only what belongs to the curve is kept: the smallest component around it, or else the contour nearest to
/// it with its component (an open one alone). Each plane looks at the faces near it only: O(n log n) once, then about the number
/// of pieces, in parallel. Throws Error (usage) for a curve without length or a count below 1 or above a million, else as
/// slice_mesh.
CurveSlices slice_along(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces = {});

}  // namespace ostraka
