#include "registration/grid_pose.h"

#include "ostraka/core/progress.h"
#include "ostraka/geom/plane_motion.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

SurfacePoints thinned(const SurfacePoints& points, std::size_t count) {
    if (points.size() <= count) return points;
    SurfacePoints result;
    result.spacing = points.spacing;
    for (std::size_t k = 0; k < count; ++k) {
        result.places.push_back(points.places[k * points.size() / count]);
        result.normals.push_back(points.normals[k * points.size() / count]);
    }
    return result;
}

double score_on(const NearestGrid& grid, const SurfacePoints& part, const Motion& pose, const Nearness& near) {
    double sum = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
        const Vector3d p = pose(part.places[i]), n = pose.rotation * part.normals[i];
        const int j = grid.find(p, n);
        if (j < 0) continue;
        const auto k = static_cast<std::size_t>(j);
        const Vector3d& m = grid.points().normals[k];
        const Vector3d d = p - grid.points().places[k];
        // The distance from the tangent plane, unless the point is off to the side, beyond a border.
        const double distance = d.dot(m), aside = (d - distance * m).norm();
        sum += near(std::hypot(distance, std::max(0.0, aside - grid.points().spacing))) * std::clamp(2 * n.dot(m) - 1, 0.0, 1.0);
    }
    return sum / static_cast<double>(part.size());
}

Motion refined_on(const NearestGrid& grid, const SurfacePoints& part, Motion pose, double tolerance, int rounds, bool scale) {
    for (int round = 0; round < rounds; ++round) {
        check_cancelled();
        const double t = static_cast<double>(round) / std::max(1, rounds - 1);
        const double search_radius =
            std::pow(grid.search_radius(), 1 - t) * std::pow(std::min(grid.search_radius(), 1.5 * tolerance), t);
        const Vector3d centre = pose(Vector3d::Zero());
        PlaneMotion planes(centre, grid.search_radius());
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Vector3d p = pose(part.places[i]), normal = pose.rotation * part.normals[i];
            const int j = grid.find(p, normal);
            if (j < 0) continue;
            const auto k = static_cast<std::size_t>(j);
            const Vector3d& to = grid.points().normals[k];
            const double distance = to.dot(grid.points().places[k] - p),
                         ratio = (grid.points().places[k] - p).norm() / search_radius;
            if (ratio >= 1 || normal.dot(to) < 0.5) continue;
            planes.add(p, to, distance, (1 - ratio * ratio) * (1 - ratio * ratio));
        }
        PlaneMotion::Step step = planes.solve(1e-6, scale);
        if (const double angle = step.rotation.norm(); angle > 0.5) step.rotation *= 0.5 / angle;
        step.growth = std::clamp(step.growth, -0.05, 0.05);
        pose = planes.motion(step).after(pose);
    }
    return pose;
}

}  // namespace ostraka::detail
