// Replaces the part of a surface that a patch of another surface covers by this patch.
#pragma once

#include "reconstruction/patch.h"

#include "ostraka/geom/surface_search.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A surface joined with a patch.
struct Joint {
    Mesh mesh;
    /// For each face of `mesh`, index of the surface's face that contains the face; no_index: the face is from the patch.
    std::vector<Index> old_face;
    /// For each face of `mesh`, index of the patch's face that contains the face; no_index: the face is from the surface.
    std::vector<Index> patch_face;
    std::size_t patch_faces = 0;  ///< number of faces of the patch that remain in `mesh`
    std::string problem;          ///< why the patch could not be joined; empty: it was joined
};

/// Replaces the covered part of the surface by the patch. `places`: projections of the patch's vertices onto the surface.
/// Vertices of the surface within `width` of the seam follow the seam, except those marked in `frozen`. Erodes the patch where
/// its border is not simple and where faces near the seam intersect; if this does not converge, returns the result with the
/// fewest intersections.
Joint join_patch(const Mesh& surface, Patch patch, const std::vector<std::optional<SurfaceHit>>& places, double width,
                 const std::vector<bool>& frozen);

}  // namespace ostraka
