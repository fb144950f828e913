#include "registration/nearest_grid.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>

namespace ostraka::detail {

template <class Visit>
void NearestGrid::around(std::size_t point, Visit&& visit) const {
    const Vector3d& p = points_.places[point];
    Eigen::Vector3i first, last;
    for (int k = 0; k < 3; ++k) {
        first[k] = std::clamp(static_cast<int>((p[k] - low_[k] - search_radius_) / side_), 0, count_[k] - 1);
        last[k] = std::clamp(static_cast<int>((p[k] - low_[k] + search_radius_) / side_), 0, count_[k] - 1);
    }
    for (int x = first[0]; x <= last[0]; ++x)
        for (int y = first[1]; y <= last[1]; ++y)
            for (int z = first[2]; z <= last[2]; ++z) {
                const double squared = (low_ + side_ * Vector3d(x + 0.5, y + 0.5, z + 0.5) - p).squaredNorm();
                if (squared < search_radius_ * search_radius_) visit(index(x, y, z), static_cast<float>(squared));
            }
}

NearestGrid::NearestGrid(const SurfacePoints& points, double search_radius) : points_(points), search_radius_(search_radius) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : points.places) box.extend(p);
    const double longest = box.sizes().maxCoeff() + 2 * search_radius;
    side_ = longest / 72;
    low_ = box.min() - Vector3d::Constant(search_radius);
    for (int k = 0; k < 3; ++k) count_[k] = std::min(73, static_cast<int>((box.sizes()[k] + 2 * search_radius) / side_) + 1);
    const std::size_t cells =
        static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) * static_cast<std::size_t>(count_[2]);
    nearest_.assign(cells, -1);
    opposite_.assign(cells, -1);
    std::vector<float> distance(cells, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < points.size(); ++i)
        around(i, [&](std::size_t cell, float squared) {
            if (squared < distance[cell]) distance[cell] = squared, nearest_[cell] = static_cast<int>(i);
        });
    std::fill(distance.begin(), distance.end(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < points.size(); ++i)
        around(i, [&](std::size_t cell, float squared) {
            if (squared < distance[cell] && points.normals[i].dot(points.normals[static_cast<std::size_t>(nearest_[cell])]) < 0.3)
                distance[cell] = squared, opposite_[cell] = static_cast<int>(i);
        });
}

}  // namespace ostraka::detail
