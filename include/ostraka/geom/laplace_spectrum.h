// The tones of a surface: eigenvalues of its Laplacian, which bending does not change.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// The first `count` eigenvalues above zero of the Laplacian of the connected part with the largest area, times that area:
/// numbers that neither place nor size nor bending change (Reuter, Wolter and Peinecke 2006). Ascending; of a ball 8 pi three
/// times, 24 pi five times, 48 pi seven times. Cotangent Laplacian and a third of the faces' areas as mass; borders are free. By
/// inverse iteration of a subspace from a fixed start, to 1e-6 relative or better; one sparse factorisation. Empty for parts of
/// fewer than 4 times `count` + 4 vertices, or where they cannot be found.
std::vector<double> laplace_spectrum(const Mesh& mesh, int count);

}  // namespace ostraka
