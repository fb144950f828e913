// Discrete mean and Gaussian curvature: values at vertices, and integrals over faces.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Options of `curvature`.
struct CurvatureOptions {
    /// Radius of the neighbourhood, as a fraction of the diagonal of the mesh's bounding box; 0: only the faces around the
    /// vertex.
    double scale = 0;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Curvature of a mesh, one value per vertex; NaN where undefined (border vertices, isolated vertices, faces without area).
struct Curvature {
    /// Mean curvature (k1 + k2) / 2 in 1/length, positive on a convex surface with outward normals.
    std::vector<double> mean;
    std::vector<double> gaussian;  ///< Gaussian curvature k1 k2 in 1/length^2
};

/// Curvature at the vertices. scale 0: the measures of Cohen-Steiner and Morvan (2003) over the faces around a vertex (edges on
/// the outline of these faces count half), divided by the area of these faces. scale r > 0: H = (sum w h . sum w a) / |sum w a|^2
/// over the part of the ball of radius r that is connected with the vertex, where h is the mean curvature vector of an edge
/// (Sullivan 2008), a the area vector of a face and w falls smoothly to zero at distance r. This estimate of H is exact on
/// spheres and cylinders for any r, and insensitive to noise to first order. K = sum w (angle deficit) / sum w A. The sums leave
/// out faces with a border edge (for K: with a border vertex), whose dihedral angles or deficits are unknown, so that the values
/// one ring inside a border are those of the surface; a vertex with such faces only is evaluated from its own edges and angles.
/// Border vertices have no curvature. Time: vertices times vertices in a ball. Throws Error (usage) for a scale out of range.
Curvature curvature(const Mesh& mesh, const CurvatureOptions& options = {});

/// Curvature integrals over each face; the integral over a region is the sum over its faces. An edge of length l and dihedral
/// angle b (positive where convex) has the mean curvature integral l b / 2, half for each of its two faces; the angle deficit of
/// a vertex is distributed over its faces by their angles (Cohen-Steiner and Morvan 2003). Border edges and border vertices are
/// not included.
struct CurvatureIntegrals {
    std::vector<double> mean;      ///< per face: integral of the mean curvature, in units of length
    std::vector<double> gaussian;  ///< per face: integral of the Gaussian curvature, in radians
};
CurvatureIntegrals curvature_integrals(const Mesh& mesh);

/// Area and curvature integrals of a region, summed in the order of `faces`.
struct RegionCurvature {
    double area = 0, mean_integral = 0, gaussian_integral = 0;  ///< integrals in units of length, and in radians
    /// Mean curvature averaged over the region.
    [[nodiscard]] double mean() const { return area > 0 ? mean_integral / area : 0; }
    /// Gaussian curvature averaged over the region.
    [[nodiscard]] double gaussian() const { return area > 0 ? gaussian_integral / area : 0; }
};
RegionCurvature region_curvature(const Mesh& mesh, const CurvatureIntegrals& integrals, const std::vector<Index>& faces);

}  // namespace ostraka
