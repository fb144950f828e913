// Grid lookup of the nearest point of a surface, for searches over many poses.
#pragma once

#include "registration/surface_points.h"

#include <vector>

namespace ostraka::detail {

/// Grid whose cells within `search_radius` of a surface point store the point nearest to the cell's centre, and the nearest point
/// with a different normal direction: on a thin wall, the point on the other side.
class NearestGrid {
public:
    /// `points` must outlive the grid.
    NearestGrid(const SurfacePoints& points, double search_radius);

    /// Index of the surface point nearest to `place` whose normal has a cosine of more than 0.3 with `normal`; -1 if there is
    /// none within the search radius.
    [[nodiscard]] int find(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const {
        const Eigen::Vector3d cell_place = (place - low_) / side_;
        if (!(cell_place.minCoeff() >= 0 && cell_place.x() < count_[0] && cell_place.y() < count_[1] &&
              cell_place.z() < count_[2]))
            return -1;
        const std::size_t cell =
            index(static_cast<int>(cell_place.x()), static_cast<int>(cell_place.y()), static_cast<int>(cell_place.z()));
        for (const int i : {nearest_[cell], opposite_[cell]})
            if (i >= 0 && points_.normals[static_cast<std::size_t>(i)].dot(normal) > 0.3) return i;
        return -1;
    }
    [[nodiscard]] const SurfacePoints& points() const { return points_; }
    [[nodiscard]] double search_radius() const { return search_radius_; }

private:
    [[nodiscard]] std::size_t index(int x, int y, int z) const {  ///< index of a cell
        return (static_cast<std::size_t>(x) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[2]) +
               static_cast<std::size_t>(z);
    }
    template <class Visit>
    /// Calls visit(cell, squared distance) for each cell within the search radius of a point.
    void around(std::size_t point, Visit&& visit) const;

    const SurfacePoints& points_;
    double search_radius_, side_ = 0;  ///< side_: side of a cell
    Eigen::Vector3d low_;              ///< lowest corner of the grid
    Eigen::Vector3i count_;            ///< number of cells along each axis
    /// For each cell, index of the nearest point, and of the nearest point with a different normal; -1: none.
    std::vector<int> nearest_, opposite_;
};

}  // namespace ostraka::detail
