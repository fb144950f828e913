// Conversion between pixels and rays in the surface's own coordinates (surface.h).
#pragma once

#include "ostraka/render/camera.h"

#include <Eigen/Core>

#include <functional>

namespace ostraka::detail {

struct Camera {
    Eigen::Vector3d right, up, toward;  ///< unit vectors; right x up = toward, which points to the viewer
    Eigen::Vector3d centre{0, 0, 0};    ///< the point shown at (middle_x, middle_y)
    double scale = 1;                   ///< pixels per unit of length; in perspective at the depth of `centre`
    double distance = 0;                ///< distance from `centre` to the eye; 0 for parallel projection
    double middle_x = 0, middle_y = 0;  ///< pixel coordinates of `centre`

    struct Ray {
        Eigen::Vector3d origin, direction;
    };

    /// Line of sight through the pixel coordinates x, y.
    [[nodiscard]] Ray ray(double x, double y) const {
        const Eigen::Vector3d place = centre + (x - middle_x) / scale * right + (middle_y - y) / scale * up;
        if (distance == 0) return {place + 4 * toward, -toward};
        const Eigen::Vector3d eye = centre + distance * toward;
        return {eye, (place - eye).normalized()};
    }

    /// Unit vector from a point towards the viewer.
    [[nodiscard]] Eigen::Vector3d to_viewer(const Eigen::Vector3d& point) const {
        return distance == 0 ? toward : (centre + distance * toward - point).normalized();
    }
    /// Distance from a point to the viewer; a distance beyond the object for parallel projection.
    [[nodiscard]] double distance_to_viewer(const Eigen::Vector3d& point) const {
        return distance == 0 ? 8 : (centre + distance * toward - point).norm();
    }

    /// Writes the pixel coordinates of a point to `x` and `y`; returns false if the point lies behind the viewer.
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

/// Places the camera so that all points fit a pane of this size with a margin; `point(i)` returns the i-th of `count` points. The
/// camera does not depend on the order of the points.
Camera fit_camera(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& point, const View& view,
                  const std::array<double, 3>& up, double width, double height, bool perspective);

/// Converts a camera from the surface's coordinates to the mesh's. `middle`: origin of the surface's coordinates in the mesh;
/// `unit`: length of one unit of the surface's coordinates in the mesh's unit.
PictureCamera in_mesh_coordinates(const Camera& camera, const std::array<double, 3>& middle, double unit);

/// Height of the strip for the scale bar under an object, in nominal pixels.
inline constexpr double bar_strip = 44;
/// Size of text and marks in a picture of this size, relative to a picture 900 pixels high.
double mark_size(int width, int height);

}  // namespace ostraka::detail
