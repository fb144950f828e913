// Measures of a whole surface that are invariant to position, orientation and size, and nearly invariant to posture.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

/// Measures of a surface.
struct WholeShape {
    /// 6 sqrt(pi) V / A^1.5 of volume V and area A: 1 for a ball, less for any other shape. Empty for a surface that is open or
    /// inside out.
    std::optional<double> compactness;
    /// Geodesic distances between points of the surface, relative to the square root of the area: mean, maximum, and standard
    /// deviation divided by the mean. Bending the surface does not change these distances.
    std::optional<double> geodesic_mean, geodesic_max, geodesic_variation;
    /// Farthest-point sampling: geodesic distance of the second, fourth and sixth sampled point from the previously sampled
    /// points, relative to the square root of the area. The first point is the point farthest from the centre.
    std::optional<double> second_point, fourth_point, sixth_point;
    /// Shape diameter (`thickness`) over the surface: mean, relative to the square root of the area; median and 90th percentile
    /// by area, relative to the mean. Empty if the thickness is unknown on a tenth of the surface or more, because rays leave
    /// the object without a hit.
    std::optional<double> thickness_mean, thickness_median, thickness_most;
    /// Volume of the object relative to the volume of its convex hull, and compactness of the hull; empty if `compactness` is
    /// empty. These values depend on posture.
    std::optional<double> hull_share, hull_compactness;
    /// Curvature integrals over the surface. curvature: signed integral of the mean curvature divided by the square root of the
    /// area (2 sqrt(pi) for a ball). concave: absolute value of the same integral over the concave part only. saddles: integral
    /// of the absolute Gaussian curvature divided by 4 pi (1 for convex shapes). Empty if the surface is open.
    std::optional<double> curvature, concave, saddles;
    /// Spectrum of the surface by `laplace_spectrum`: twelve values, or empty.
    std::vector<double> spectrum;
    static constexpr int spectrum_size = 12;  ///< number of values in the spectrum
};

/// Measures a whole surface. Geodesics start from 8 sources, chosen by farthest-point sampling, on a copy simplified to 1500
/// vertices; curvature and spectrum use the same copy. Pairs of points in different components are ignored. Thickness is
/// measured on a copy simplified to 600 vertices. Throws Error (input) for a mesh without area.
WholeShape measure_whole_shape(const Mesh& mesh);

}  // namespace ostraka
