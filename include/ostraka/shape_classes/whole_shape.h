// Numbers of a whole surface that neither place nor size nor, nearly, posture change.
#pragma once

#include "ostraka/core/mesh.h"

#include <optional>

namespace ostraka {

struct WholeShape {
    /// 6 sqrt(pi) V / A^1.5: 1 of a ball, less of anything else. None of an open surface, or one turned inside out.
    std::optional<double> compactness;
    /// Of the lengths of shortest curves between the points of the surface, as shares of the square root of the area: mean,
    /// greatest, and standard deviation over the mean. Bending does not change them.
    std::optional<double> geodesic_mean, geodesic_max, geodesic_variation;
};

/// Geodesics run from 8 sources, each the farthest from those before it, over a copy simplified to 1500 vertices; pairs in
/// different components do not count. Throws Error (input) for a mesh without area.
WholeShape measure_whole_shape(const Mesh& mesh);

}  // namespace ostraka
