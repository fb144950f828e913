// Samples and rim frames of a fragment's fracture.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/point_tree.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// A point on the rim of a fracture, with the directions of the adjacent surfaces.
struct RimFrame {
    /// Position; unit normals of the adjacent intact side and of the fracture surface.
    Eigen::Vector3d place, side, fracture;
    /// Centroid of the intact faces near the point, where the surface continues away from a worn edge.
    Eigen::Vector3d beside;
    Facet facet = Facet::outer;  ///< facet class of the intact side
    /// Orthonormal axes of the frame, as columns.
    [[nodiscard]] Eigen::Matrix3d axes() const;
    /// The rigid motion that maps this frame onto `other` so that the fracture surfaces face each other.
    [[nodiscard]] Motion onto(const RimFrame& other) const;
};

/// A connected part of the rim as an ordered sequence of points, with the fracture on the left when seen from outside.
struct RimLoop {
    /// Points of the rim, smoothed along the loop; unit normals of the intact side at each point.
    std::vector<Eigen::Vector3d> places, sides;
    std::vector<Facet> facets;  ///< facet class of the intact side at each point
    bool closed = true;         ///< true: a closed loop; false: cut by the border of the mesh
};

/// Minimum cosines between opposite normals of fractures that face each other, and between normals of sides that continue each
/// other.
constexpr double min_facing = 0.5, continued = 0.7;

/// The positions of rim frames.
std::vector<Point> places_of(const std::vector<RimFrame>& frames);

/// Points evenly spread over faces, each representing the same area.
struct SurfaceSamples {
    std::vector<Eigen::Vector3d> places, normals;  ///< position and unit normal of each point
    double area = 0;                               ///< total area of the sampled faces
};

/// About `count` points on the chosen faces; a point gets its normal from `normals`, which has one entry per face.
SurfaceSamples sample_faces(const Mesh& mesh, const std::vector<Vector>& normals, const std::vector<bool>& chosen, int count);

/// Samples and rim of one fragment's fracture.
struct FractureSide {
    FractureSide() = default;
    /// Samples a fragment. `radius`: distance within which the directions at the rim are averaged.
    FractureSide(const Fragment& fragment, double radius, int frame_count, int sample_count);

    std::vector<RimFrame> frames;                                  ///< frames along the rim
    SurfaceSamples fracture, intact;                               ///< samples of the fracture surface and of the intact surface
    std::vector<RimLoop> loops;                                    ///< the whole rim
    double rim_length = 0;                                         ///< total length of the rim
    [[nodiscard]] FractureSide moved(const Motion& motion) const;  ///< a copy after a rigid motion
};

/// Size of a fragment: square root of its surface area.
double fragment_size(const Mesh& mesh);

/// Finds an approximately nearest sample for points in a box, by a grid whose cells store the sample nearest to the cell.
class SampleGrid {
public:
    /// `margin`: distance of the box from the samples; `cells`: number of cells along the longest side of the box.
    SampleGrid(const std::vector<Eigen::Vector3d>& places, double margin, int cells = 64);
    /// Index of a sample that is nearest to `place` up to an error of about the width of a cell; no_index outside the box.
    [[nodiscard]] Index near(const Eigen::Vector3d& place) const {
        const Eigen::Vector3d cell = (place - low_) / width_;
        if (!(cell.minCoeff() >= 0)) return no_index;
        const auto x = static_cast<std::size_t>(cell[0]), y = static_cast<std::size_t>(cell[1]),
                   z = static_cast<std::size_t>(cell[2]);
        if (x >= count_[0] || y >= count_[1] || z >= count_[2]) return no_index;
        return nearest_[(z * count_[1] + y) * count_[0] + x];
    }

private:
    Eigen::Vector3d low_;
    double width_ = 1;
    std::array<std::size_t, 3> count_{};
    std::vector<Index> nearest_;
};

}  // namespace ostraka
