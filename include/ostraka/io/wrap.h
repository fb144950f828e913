// The watertight wrap of triangles of any kind.
#pragma once

#include "ostraka/core/mesh.h"

namespace ostraka {

/// Closed, an oriented manifold, without self-intersections, strictly around the triangles: `offset` from them, and over openings
/// narrower than `alpha` (lengths in the soup's unit; Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022, by CGAL).
/// Throws Error (failure) where nothing comes of it.
TriangleSoup wrap_soup(const TriangleSoup& soup, double alpha, double offset);

}  // namespace ostraka
