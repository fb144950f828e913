// Data for matching a fragment's fracture, precomputed once.
#pragma once

#include "fracture/fracture_side.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/geom/line_complex.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

/// The precomputed data of a fragment's fracture.
struct PreparedFracture::Parts {
    Mesh mesh;                                         ///< surface of the fragment
    std::string name;                                  ///< name of the fragment
    double size = 0;                                   ///< square root of the surface area
    double width = 0;                                  ///< width of the fracture (PreparedFracture::width)
    std::size_t faces = 0;                             ///< number of fracture faces
    double relief = 0;                                 ///< root mean square deviation of the fracture from a quadric fitted to it
    double noise = 0;                                  ///< noise of the intact surface, a length (surface_noise)
    double edge = 0;                                   ///< mean edge length of the mesh
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< centroid of the intact surface
    LineComplex lines;  ///< line complex fitted to the normals of the intact surface, relative to `middle`
    /// Root mean square distance of the normals of the intact surface from the axis fitted to them.
    double off_axis = 0;
    FractureSide side;                             ///< samples and rim of the fracture
    PointTree fracture, frames;                    ///< search trees of the fracture samples and of the rim frames
    std::vector<Eigen::Vector3d> places, normals;  ///< samples of the fracture surface, then of the intact surface
    std::unique_ptr<SampleGrid> grid;              ///< grid that finds entries of `places`
    std::unique_ptr<SurfaceSearch> surface;        ///< search tree of the mesh
};

/// How much worse one common axis fits the normals of two intact surfaces (b moved by `pose`) than one axis each: root of the
/// difference of the mean squared distances, so that noise cancels.
double common_axis_deviation(const PreparedFracture::Parts& a, const PreparedFracture::Parts& b, const Motion& pose);

/// Noise of an intact surface (scanner, grain, coarse triangles): median over small neighbourhoods of the root mean square
/// deviation from a quadric; 0 for fewer than ten samples.
double surface_noise(const SurfaceSamples& intact);

/// Root mean square deviations of points from the fitted plane and from the fitted quadric; 0 for fewer than ten points.
std::pair<double, double> deviations(const std::vector<Eigen::Vector3d>& places);

}  // namespace ostraka
