#include "fracture/rotations.h"

#include "ostraka/core/angles.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

int ProfileCells::row(const Vector3d& p, const Vector3d& normal, double search_radius) {
    const auto hit = surface_.closest_compatible(point_of(p), vector_of(normal), 0.5, search_radius);
    if (!hit) return -1;
    const double radius = std::hypot(hit->point.x(), hit->point.y());
    const std::pair cell(std::lround(radius / width_), std::lround(hit->point.z() / width_));
    return cell_rows_.try_emplace(cell, static_cast<int>(cell_rows_.size())).first->second;
}

RotationMap::RotationMap(ProfileCells& cells, const SurfaceSamples& surface, const std::vector<Vector3d>& fracture, int steps,
                         double margin, double search_radius)
    : steps_(steps), area_(surface.area) {
    if (surface.places.empty()) return;
    area_per_sample_ = surface.area / static_cast<double>(surface.places.size());
    const PointTree tree(points_of(fracture));
    const double step = 2 * pi / steps;
    for (std::size_t i = 0; i < surface.places.size(); ++i) {
        const Vector3d& p = surface.places[i];
        const int row = cells.row(p, surface.normals[i], search_radius);
        if (row < 0) continue;
        const int column = static_cast<int>(std::lround(std::atan2(p.y(), p.x()) / step) + steps) % steps;
        if (fracture.empty() || tree.nearest(point_of(p), margin).index == no_index) deep_.push_back({row, column});
        if (covered_.size() <= static_cast<std::size_t>(row)) covered_.resize(static_cast<std::size_t>(row) + 1);
        auto& covered_columns = covered_[static_cast<std::size_t>(row)];
        if (covered_columns.empty()) covered_columns.assign(static_cast<std::size_t>(steps), false);
        const double radius = std::max(std::hypot(p.x(), p.y()), 0.5 * cells.width());
        const int half = std::min(static_cast<int>(std::lround(0.5 * cells.width() / radius / step)), steps / 2);
        for (int k = -half; k <= half; ++k) covered_columns[static_cast<std::size_t>((column + k + steps) % steps)] = true;
    }
}

std::vector<double> RotationMap::shared(const RotationMap& other) const {
    std::vector<double> area(static_cast<std::size_t>(steps_), 0);
    for (const Place& place : deep_) {
        const auto row = static_cast<std::size_t>(place.row);
        if (row >= other.covered_.size() || other.covered_[row].empty()) continue;
        const std::vector<bool>& covered_columns = other.covered_[row];
        // The other map rotated by t covers column c if it covered c - t before.
        for (int t = 0; t < steps_; ++t)
            if (covered_columns[static_cast<std::size_t>((place.column - t + steps_) % steps_)])
                area[static_cast<std::size_t>(t)] += area_per_sample_;
    }
    return area;
}

}  // namespace ostraka
