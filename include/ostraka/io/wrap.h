// Watertight wrap of any triangle soup.
#pragma once

#include "ostraka/mesh/mesh.h"

namespace ostraka {

/// Computes a closed, oriented manifold without self-intersections that strictly encloses the triangles. The wrap lies at the
/// distance `offset` from the triangles and closes openings narrower than twice `alpha` (both in the soup's unit; Portaneri,
/// Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022, implemented by CGAL). Throws Error (failure) if the result is empty.
TriangleSoup wrap_soup(const TriangleSoup& soup, double alpha, double offset);

}  // namespace ostraka
