// Slices across a curve, for example a skeleton.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

/// Slices across a curve.
struct CurveSlices {
    /// Frame of each slice: origin on the curve, normal along the curve; u is rotation-minimising.
    std::vector<SliceFrame> frames;
    std::vector<Slice> slices;  ///< slices in the planes of the frames; `height` is the arc length along the curve
    double length = 0;          ///< length of the curve
    bool reversed = false;      ///< true: the mesh is closed and inside out, and all contours were reversed
};

/// Slices across the curve at the midpoints of `count` pieces of equal length. The tangent at a midpoint is the direction of the
/// chord that extends one piece to each side. In each plane only the component at the curve is kept: the smallest component
/// around the curve, otherwise the component of the nearest contour (an open contour alone). Each plane searches only the faces
/// near it: O(n log n) once, then about linear in the number of pieces, in parallel. Throws Error (usage) for a curve without
/// length or a count below 1 or above a million, and the errors of slice_mesh.
CurveSlices slice_along(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces = {});

}  // namespace ostraka
