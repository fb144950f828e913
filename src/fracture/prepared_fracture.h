// Data for matching a fragment's fracture, precomputed once.
#pragma once

#include "fracture/fracture_side.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/geom/line_complex.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

struct PreparedFracture::Parts {
    Mesh mesh;
    std::string name;
    double size = 0;                                   ///< square root of the surface area
    double width = 0;                                  ///< of the fracture: see PreparedFracture::width
    std::size_t faces = 0;                             ///< number of fracture faces
    double relief = 0;                                 ///< root mean square deviation of the fracture from its quadric
    double noise = 0;                                  ///< noise of the intact surface, a length: see surface_noise
    double edge = 0;                                   ///< mean edge length of the mesh
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< centroid of the intact surface
    LineComplex lines;                                 ///< of the normals of the intact surface, relative to the centroid
    double off_axis = 0;                               ///< root mean square distance of these normals from their best axis
    FractureSide side;
    PointTree fracture, frames;
    std::vector<Eigen::Vector3d> places, normals;  ///< fracture first, then intact surface
    std::unique_ptr<SampleGrid> grid;              ///< over `places`
    std::unique_ptr<SurfaceSearch> surface;
};

/// How much farther the normals of two intact surfaces are from the best common axis, b moved by `pose`, than from an axis
/// each: root of the difference of the mean squares, so that noise cancels.
double common_axis_deviation(const PreparedFracture::Parts& a, const PreparedFracture::Parts& b, const Motion& pose);

/// Deviation of an intact surface from quadrics over small neighbourhoods: effect of scanner, grain and coarse triangles.
/// Median of root mean squares; 0 for fewer than ten samples.
double surface_noise(const SurfaceSamples& intact);

/// Root mean square deviations of points from their plane and from their quadric; 0 for fewer than ten points.
std::pair<double, double> deviations(const std::vector<Eigen::Vector3d>& places);

}  // namespace ostraka
