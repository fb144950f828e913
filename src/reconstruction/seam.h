// A patch of one surface put in the place of what it covers of another.
#pragma once

#include "patch.h"

#include "ostraka/geom/surface_search.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct Joint {
    Mesh mesh;
    std::vector<Index> old_face;    ///< of the surface, which each face is or is cut from; no_index: the patch's
    std::vector<Index> patch_face;  ///< the same of the patch
    std::size_t patch_faces = 0;    ///< of the patch that are left
    std::string problem;            ///< why there is none
};

/// The surface with the patch in place of what it covers. `places` of the patch's vertices on the surface; vertices of the
/// surface within `width` of the seam follow it but for those `frozen`. Erodes the patch where its border is not simple, and
/// where faces near the seam cross; where that does not end, the joint with the fewest crossings is taken.
Joint join_patch(const Mesh& surface, Patch patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                 const std::vector<bool>& frozen);

}  // namespace ostraka
