// Numbers of a whole surface that neither place nor size nor, nearly, posture change.
#pragma once

#include "ostraka/core/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

struct WholeShape {
    /// 6 sqrt(pi) V / A^1.5: 1 of a ball, less of anything else. None of an open surface, or one turned inside out.
    std::optional<double> compactness;
    /// Of the lengths of shortest curves between the points of the surface, as shares of the square root of the area: mean,
    /// greatest, and standard deviation over the mean. Bending does not change them.
    std::optional<double> geodesic_mean, geodesic_max, geodesic_variation;
    /// How far the second, the fourth and the sixth of points that are each as far as can be from those before it, is from these;
    /// the first is the farthest from the middle. As shares of the square root of the area.
    std::optional<double> second_point, fourth_point, sixth_point;
    /// Shape diameter (`thickness`) over the surface: mean, as a share of the square root of the area; median, and what is
    /// exceeded on a tenth of the surface, over the mean. None where rays leave a tenth of the surface or more without meeting
    /// it.
    std::optional<double> thickness_mean, thickness_median, thickness_most;
    /// Volume over that of the convex hull, and compactness of the hull; as above. Posture changes them.
    std::optional<double> hull_share, hull_compactness;
    /// Integrals over the surface, by face: of mean curvature, over the square root of the area (signed; 2 sqrt(pi) of a ball);
    /// the part of its absolute value that is concave; of absolute Gaussian curvature, over 4 pi (1 of what is convex). None
    /// without a volume.
    std::optional<double> curvature, concave, saddles;
    /// `laplace_spectrum`: twelve numbers, or none.
    std::vector<double> spectrum;
    static constexpr int spectrum_size = 12;
};

/// Geodesics run from 8 sources, each the farthest from those before it, over a copy simplified to 1500 vertices, of which
/// curvature and spectrum are, too; pairs in different components do not count. Thickness is taken on a copy simplified to 600
/// vertices. Throws Error (input) for a mesh without area.
WholeShape measure_whole_shape(const Mesh& mesh);

}  // namespace ostraka
