// All that is asked of a fragment when its break is laid against others, made once.
#pragma once

#include "break_side.h"
#include "ostraka/fracture/break_pair.h"
#include "ostraka/geom/line_complex.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

struct PreparedBreak::Parts {
    Mesh mesh;
    std::string name;
    double size = 0;        ///< square root of the surface's area
    double width = 0;       ///< of the fracture: twice its area by the length of its rim; of a sherd that is its wall
    std::size_t faces = 0;  ///< of the fracture
    double relief = 0;      ///< root mean square deviation of the fracture from its quadric
    double noise = 0;       ///< of the intact surface, a length: see surface_noise
    double edge = 0;        ///< mean length of the mesh's edges
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of the intact surface
    LineComplex lines;                                 ///< of its normals, about the middle
    double off_axis = 0;                               ///< root mean square distance of these from their best axis
    BreakSide side;
    PointTree fracture, frames;
    std::vector<Eigen::Vector3d> places, normals;  ///< fracture first, then intact surface
    std::unique_ptr<SampleGrid> grid;              ///< of places
    std::unique_ptr<SurfaceSearch> surface;
};

/// How much farther the normals of two intact surfaces are off the best axis of both, b moved by `pose`, than off an axis each:
/// root of the difference of mean squares, so that noise does not count.
double off_common_axis(const PreparedBreak::Parts& a, const PreparedBreak::Parts& b, const Motion& pose);

/// How far an intact surface deviates from quadrics over small neighbourhoods: what scanner, grain and coarse triangles leave.
/// Median of root mean squares; 0 of fewer than ten samples.
double surface_noise(const SurfaceSamples& intact);

/// Root mean square deviations of places from their plane and from a quadric over it; 0 of fewer than ten.
std::pair<double, double> deviations(const std::vector<Eigen::Vector3d>& places);

}  // namespace ostraka
