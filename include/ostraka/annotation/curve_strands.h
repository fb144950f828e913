// Curves of several annotations taken apart where they meet, so that what they share is worked on once.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_trace.h"

#include <vector>

namespace ostraka {

/// A stretch of curves between junctions, or a loop without any, which repeats its first place.
struct CurveStrand {
    std::vector<SurfacePlace> places;  ///< in the same order for all curves that share it
    bool closed = false;
};

/// A strand as a part of a curve.
struct StrandUse {
    std::size_t strand;
    bool backwards;
};

/// Takes the curves of the chosen annotations apart at junctions: places with other than two neighbours, ends of curves, and
/// vertices at the border of the mesh. Equal stretches become one strand, however they run. Adds the strands to `strands` and
/// returns, by annotation and curve, the strands that make it up in turn; nothing for annotations that are not chosen and for
/// curves of one place. O(k log k) for k places.
std::vector<std::vector<std::vector<StrandUse>>> take_apart(const Mesh& mesh,
                                                            const std::vector<std::vector<std::vector<SurfacePlace>>>& curves,
                                                            const std::vector<bool>& chosen, std::vector<CurveStrand>& strands);

}  // namespace ostraka
