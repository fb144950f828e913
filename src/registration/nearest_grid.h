// Grid lookup of the nearest point of a surface, for searches over many poses.
#pragma once

#include "registration/surface_points.h"

#include <vector>

namespace ostraka::detail {

/// Each cell within `search_radius` of a point stores the point nearest to its centre, and the nearest point with a different
/// normal direction: on a thin wall, the other side.
class NearestGrid {
public:
    NearestGrid(const SurfacePoints& points, double search_radius);

    /// The nearest point of the surface whose normal has a cosine of more than 0.3 with `normal`; -1 if there is none near.
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
    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(x) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[2]) +
               static_cast<std::size_t>(z);
    }
    template <class Visit>
    void around(std::size_t point, Visit&& visit) const;

    const SurfacePoints& points_;
    double search_radius_, side_ = 0;
    Eigen::Vector3d low_;
    Eigen::Vector3i count_;
    std::vector<int> nearest_, opposite_;
};

}  // namespace ostraka::detail
