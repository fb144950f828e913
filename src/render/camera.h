// From pixels to rays and back, in the surface's own coordinates (see surface.h).
#pragma once

#include "ostraka/render/view.h"

#include <Eigen/Core>

namespace ostraka::detail {

struct Camera {
    Eigen::Vector3d right, up, toward;  ///< unit vectors; right x up = toward, which points to the viewer
    Eigen::Vector3d centre{0, 0, 0};    ///< the point that is seen in the middle
    double scale = 1;                   ///< pixels per unit, in perspective at the centre's depth
    double distance = 0;                ///< from the centre to the eye; 0 for parallel rays
    double middle_x = 0, middle_y = 0;  ///< the pixel coordinates of the centre

    struct Ray {
        Eigen::Vector3d origin, direction;
    };

    [[nodiscard]] Ray ray(double x, double y) const {
        const Eigen::Vector3d place = centre + (x - middle_x) / scale * right + (middle_y - y) / scale * up;
        if (distance == 0) return {place + 4 * toward, -toward};
        const Eigen::Vector3d eye = centre + distance * toward;
        return {eye, (place - eye).normalized()};
    }

    /// Unit vector from a point to the viewer.
    [[nodiscard]] Eigen::Vector3d to_viewer(const Eigen::Vector3d& point) const {
        return distance == 0 ? toward : (centre + distance * toward - point).normalized();
    }
    [[nodiscard]] double distance_to_viewer(const Eigen::Vector3d& point) const {
        return distance == 0 ? 8 : (centre + distance * toward - point).norm();
    }

    /// Pixel coordinates; false if the point lies behind the viewer.
    bool project(const Eigen::Vector3d& point, double& x, double& y) const {
        const Eigen::Vector3d local = point - centre;
        double factor = scale;
        if (distance > 0) {
            const double depth = distance - local.dot(toward);
            if (!(depth > 1e-9)) return false;
            factor *= distance / depth;
        }
        x = middle_x + local.dot(right) * factor;
        y = middle_y - local.dot(up) * factor;
        return true;
    }
};

}  // namespace ostraka::detail
