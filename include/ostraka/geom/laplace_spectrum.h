// Laplacian spectrum of a surface, which is invariant under isometric bending.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// The first `count` positive eigenvalues of the Laplacian of the connected component with the largest area, times that area:
/// invariant under rigid motion, scaling and isometric bending (Reuter, Wolter and Peinecke 2006). Ascending; for a sphere 8 pi
/// three times, 24 pi five times, 48 pi seven times. Cotangent Laplacian; mass matrix of a third of the face areas; free
/// borders. Subspace inverse iteration from a fixed start, relative error at most 1e-6; one sparse factorisation. Empty for
/// components of fewer than 4 times `count` + 4 vertices, or if the factorisation or iteration fails.
std::vector<double> laplace_spectrum(const Mesh& mesh, int count);

}  // namespace ostraka
