// Replaces the part of a surface that a patch of another surface covers by that patch.
#pragma once

#include "reconstruction/patch.h"

#include "ostraka/geom/surface_search.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct Joint {
    Mesh mesh;
    std::vector<Index> old_face;    ///< per face, the surface's face of which it is the whole or a part; no_index: from the patch
    std::vector<Index> patch_face;  ///< the same for the patch
    std::size_t patch_faces = 0;    ///< number of faces of the patch that remain
    std::string problem;            ///< why there is no joint
};

/// The surface with the covered part replaced by the patch. `places`: projections of the patch's vertices onto the surface.
/// Vertices of the surface within `width` of the seam follow it, except those `frozen`. Erodes the patch where its border is
/// not simple and where faces near the seam intersect; if this does not converge, returns the joint with the fewest
/// intersections.
Joint join_patch(const Mesh& surface, Patch patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                 const std::vector<bool>& frozen);

}  // namespace ostraka
