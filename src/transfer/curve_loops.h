// Small loops that curves get when they are laid on another surface, and what they enclose.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_trace.h"

#include <array>
#include <vector>

namespace ostraka {

/// The barycentric weights of a node in one of its faces.
std::array<double, 3> weights_in(const Mesh& mesh, Index face, const SurfaceNode& node);

/// A curve without the loops in which it meets or crosses itself, where they enclose less than the square of `edge` and are at
/// most twenty of its length long. Ends stay; a closed one, which repeats its first place, may start elsewhere afterwards. O(km)
/// for k places, of which m lie on twenty edges.
std::vector<SurfacePlace> without_small_loops(const Mesh& mesh, std::vector<SurfacePlace> places, double edge, bool closed);

/// Takes parts of a region with less than some area out of it, and fills such holes, the smallest first, until it has no more
/// than `outlines` outlines or no small part is left. A flag per face. O(n log n) for n faces.
void dissolve_small_parts(const Mesh& mesh, double area, std::size_t outlines, std::vector<bool>& selected);

}  // namespace ostraka
