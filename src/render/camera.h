// Conversion between pixels and rays, in the surface's own coordinates (see surface.h).
#pragma once

#include "ostraka/render/camera.h"

#include <Eigen/Core>

#include <functional>

namespace ostraka::detail {

struct Camera {
    Eigen::Vector3d right, up, toward;  ///< unit vectors; right x up = toward, which points to the viewer
    Eigen::Vector3d centre{0, 0, 0};    ///< the point shown in the middle
    double scale = 1;                   ///< pixels per unit; in perspective at the depth of the centre
    double distance = 0;                ///< from the centre to the eye; 0 for parallel projection
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

/// Places the camera so that all points fit a pane of this size with a margin; `point(i)` returns the i-th of `count` points.
/// Independent of their order.
Camera fit_camera(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& point, const View& view,
                  const std::array<double, 3>& up, double width, double height, bool perspective);

/// The same camera in the mesh's coordinates: `middle` is the origin of the surface coordinates, `unit` the length of their
/// unit.
PictureCamera in_mesh_coordinates(const Camera& camera, const std::array<double, 3>& middle, double unit);

/// Height of the strip for the scale bar under an object, and size of the marks in a picture.
inline constexpr double bar_strip = 44;
double mark_size(int width, int height);

}  // namespace ostraka::detail
