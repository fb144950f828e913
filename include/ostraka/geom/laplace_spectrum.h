// Laplacian spectrum of a surface, which is invariant under isometric bending.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// The `count` smallest positive eigenvalues of the Laplacian of the connected component with the largest area, multiplied by
/// this area and ascending: invariant under rigid motion, scaling and isometric bending (Reuter, Wolter and Peinecke 2006). For a
/// sphere: 8 pi three times, 24 pi five times, 48 pi seven times. Discretisation: cotangent Laplacian, diagonal mass matrix (each
/// face gives a third of its area to each corner), free borders. Method: subspace inverse iteration from a fixed start, with a
/// relative error of at most 1e-6 and one sparse factorisation. The result is empty for components of fewer than 4 times `count`
/// + 4 vertices, or if the factorisation or iteration fails.
std::vector<double> laplace_spectrum(const Mesh& mesh, int count);

}  // namespace ostraka
