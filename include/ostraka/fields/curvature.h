// Discrete mean and Gaussian curvature: values at vertices, and integrals over faces.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

struct CurvatureOptions {
    double scale = 0;  ///< radius of the neighbourhood, as a share of the box diagonal; 0 = the faces around the vertex

    void describe(OptionList& visit);
};

/// One value per vertex; 0 if undefined (isolated vertices, faces without area).
struct Curvature {
    std::vector<double> mean;      ///< (k1 + k2) / 2 in 1/length, positive on a convex surface with outward normals
    std::vector<double> gaussian;  ///< k1 k2 in 1/length^2
};

/// Curvature at the vertices. scale 0: the measures of Cohen-Steiner and Morvan (2003) over the faces around a vertex (half of
/// the edges on their rim), divided by their area. scale r > 0: H = (sum w h . sum w a) / |sum w a|^2 over the part of the ball
/// of radius r that is connected with the vertex, where h is the mean curvature vector of an edge (Sullivan 2008), a the area
/// vector of a face and w falls smoothly to zero at r; exact on spheres and cylinders for any r, and insensitive to noise to
/// first order. K = sum w (angle deficit) / sum w A. Border edges and border vertices carry no curvature. Time: vertices times
/// vertices in a ball. Throws Error (usage) for a scale out of range.
Curvature curvature(const Mesh& mesh, const CurvatureOptions& options = {});

/// Curvature integrals over each face, which sum to those of any region: an edge of length l and dihedral angle b (positive
/// where convex) has mean curvature l b / 2, half of it for either face; the angle deficit of a vertex is distributed over its
/// faces by their angles (Cohen-Steiner and Morvan 2003). Border edges and vertices have none: curvature there belongs to the
/// border.
struct CurvatureIntegrals {
    std::vector<double> mean;      ///< per face, in units of length
    std::vector<double> gaussian;  ///< per face, in radians
};
CurvatureIntegrals curvature_integrals(const Mesh& mesh);

/// Sums over a region, in the order of `faces`.
struct RegionCurvature {
    double area = 0, mean_integral = 0, gaussian_integral = 0;
    [[nodiscard]] double mean() const { return area > 0 ? mean_integral / area : 0; }
    [[nodiscard]] double gaussian() const { return area > 0 ? gaussian_integral / area : 0; }
};
RegionCurvature region_curvature(const Mesh& mesh, const CurvatureIntegrals& integrals, const std::vector<Index>& faces);

}  // namespace ostraka
