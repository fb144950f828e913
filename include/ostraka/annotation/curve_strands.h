// Splits the curves of several annotations at their junctions, so that a stretch shared by two curves is processed once.
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// A stretch of a curve between two junctions, or a whole closed curve without junctions.
struct CurveStrand {
    /// Places along the strand; a closed strand repeats its first place at the end.
    std::vector<SurfacePoint> places;
    bool closed = false;  ///< true: a loop without junctions
};

/// One strand within a curve that is a sequence of strands.
struct StrandUse {
    std::size_t strand;  ///< index of the strand
    bool backwards;      ///< true: the curve follows the strand in reverse order
};

/// Splits the curves of the chosen annotations at junctions. A junction is a place on a curve where the curves do not continue
/// to exactly two neighbouring places, an end of a curve, or a vertex at the border of the mesh. Equal stretches of several
/// curves become one strand, even if their directions are opposite. Appends the strands to `strands`. Returns for each
/// annotation and each of its curves the sequence of strands; the sequence is empty for annotations that are not chosen and for
/// curves of one place. Time: O(k log k) for k places.
std::vector<std::vector<std::vector<StrandUse>>> separate_nonmanifold(
    const Mesh& mesh, const std::vector<std::vector<std::vector<SurfacePoint>>>& curves, const std::vector<bool>& chosen,
    std::vector<CurveStrand>& strands);

}  // namespace ostraka
