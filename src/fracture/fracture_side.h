// Samples and rim frames of a fragment's fracture.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/point_tree.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// A point on the rim of a fracture: unit normals of the adjacent intact side and, across the rim, of the fracture.
struct RimFrame {
    Eigen::Vector3d place, side, fracture;
    Eigen::Vector3d beside;      ///< centroid of the side's faces near the point: where the side continues away from a worn edge
    Facet facet = Facet::outer;  ///< facet of the side
    [[nodiscard]] Eigen::Matrix3d axes() const;
    /// The motion that maps this frame onto `other`, fractures facing each other.
    [[nodiscard]] Motion onto(const RimFrame& other) const;
};

/// An ordered part of the rim with the fracture on its left seen from outside: closed, or cut by the border of the mesh.
struct RimLoop {
    std::vector<Eigen::Vector3d> places, sides;  ///< smoothed along the loop; unit normals of the sides
    std::vector<Facet> facets;                   ///< facets of the sides
    bool closed = true;
};

/// Min cosines: of fractures that face each other, of sides that continue each other.
constexpr double min_facing = 0.5, continued = 0.7;

std::vector<Point> places_of(const std::vector<RimFrame>& frames);

/// Points evenly spread over faces, each representing the same area.
struct SurfaceSamples {
    std::vector<Eigen::Vector3d> places, normals;
    double area = 0;  ///< total area
};

/// About `count` points on the chosen faces, with the `normals` of the faces.
SurfaceSamples sample_faces(const Mesh& mesh, const std::vector<Vector>& normals, const std::vector<bool>& chosen, int count);

struct FractureSide {
    FractureSide() = default;
    FractureSide(const Fragment& fragment, double radius, int frame_count, int sample_count);

    std::vector<RimFrame> frames;
    SurfaceSamples fracture, intact;
    std::vector<RimLoop> loops;
    double rim_length = 0;
    [[nodiscard]] FractureSide moved(const Motion& motion) const;
};

/// Square root of the surface area.
double fragment_size(const Mesh& mesh);

/// Approximate nearest sample for points in a box: a grid whose cells store their nearest sample.
class SampleGrid {
public:
    /// `cells`: number along the longest side.
    SampleGrid(const std::vector<Eigen::Vector3d>& places, double margin, int cells = 64);
    /// Index of a sample near `place`, up to the width of a cell; no_index outside the box.
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
