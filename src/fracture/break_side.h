// What is asked of a fragment when its break is matched with another one.
#pragma once

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/point_tree.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// A place on the rim of a fracture: unit normals of the side beside it and, across that, of the fracture.
struct RimFrame {
    Eigen::Vector3d place, side, fracture;
    Eigen::Vector3d beside;      ///< middle of the side's faces near the place: how the side goes on away from a worn edge
    Facet facet = Facet::outer;  ///< of the side
    [[nodiscard]] Eigen::Matrix3d axes() const;
    /// The motion that lays this frame onto `other`, fractures facing each other.
    [[nodiscard]] Motion onto(const RimFrame& other) const;
};

/// A part of the rim in its order, the fracture on its left seen from outside: closed, or cut by the border of the mesh.
struct RimLoop {
    std::vector<Eigen::Vector3d> places, sides;  ///< smoothed along the loop; unit normals of the sides
    std::vector<Facet> facets;                   ///< of the sides
    bool closed = true;
};

/// Normals of fractures face each other, sides continue each other: cosines.
constexpr double min_facing = 0.5, continued = 0.7;

std::vector<Point> places_of(const std::vector<RimFrame>& frames);

/// Points evenly spread over faces, each for the same area.
struct SurfaceSamples {
    std::vector<Eigen::Vector3d> places, normals;
    double area = 0;  ///< of all
};

/// About `count` points on the chosen faces, with the faces' `normals`.
SurfaceSamples sample_faces(const Mesh& mesh, const std::vector<Vector>& normals, const std::vector<bool>& chosen, int count);

struct BreakSide {
    BreakSide() = default;
    BreakSide(const Fragment& fragment, double radius, int frame_count, int sample_count);

    std::vector<RimFrame> frames;
    SurfaceSamples fracture, intact;
    std::vector<RimLoop> loops;
    double rim_length = 0;
    [[nodiscard]] BreakSide moved(const Motion& motion) const;
};

/// Square root of the surface's area.
double fragment_size(const Mesh& mesh);

/// The nearest of some samples from anywhere in a box, by a grid of cells that each know their nearest one.
class SampleGrid {
public:
    /// `cells`: along the longest side.
    SampleGrid(const std::vector<Eigen::Vector3d>& places, double margin, int cells = 64);
    /// Index of a sample that is near `place`, to the width of a cell; none outside the box.
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
