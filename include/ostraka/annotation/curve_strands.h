// Splits the curves of several annotations at their junctions, so that shared stretches are processed once.
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// A stretch of curve between junctions, or a loop without junctions, which repeats its first place.
struct CurveStrand {
    std::vector<SurfacePoint> places;  ///< in the same order for all curves that share the strand
    bool closed = false;
};

/// A strand as part of a curve.
struct StrandUse {
    std::size_t strand;
    bool backwards;
};

/// Splits the curves of the chosen annotations at junctions: places whose number of neighbours is not two, ends of curves, and
/// vertices at the border of the mesh. Equal stretches become one strand, regardless of direction. Appends the strands to
/// `strands` and returns, by annotation and curve, the sequence of its strands; empty for annotations that are not chosen and
/// for curves of one place. O(k log k) for k places.
std::vector<std::vector<std::vector<StrandUse>>> separate_nonmanifold(
    const Mesh& mesh, const std::vector<std::vector<std::vector<SurfacePoint>>>& curves, const std::vector<bool>& chosen,
    std::vector<CurveStrand>& strands);

}  // namespace ostraka
