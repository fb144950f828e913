#include "render/camera.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {
Eigen::Vector3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

/// Tangent of half the field of view of the smaller side of a pane in perspective (30 degrees in total).
const double half_view = std::tan(15 * pi / 180);

constexpr double infinity = std::numeric_limits<double>::infinity();
}  // namespace

namespace detail {

Camera fit_camera(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& point, const View& view,
                  const std::array<double, 3>& up, double pane_width, double pane_height, bool perspective) {
    const ViewAxes axes = view_axes(view, up);
    Camera camera;
    camera.right = vector(axes.right);
    camera.up = vector(axes.up);
    camera.toward = vector(axes.toward);
    camera.middle_x = pane_width / 2;
    camera.middle_y = pane_height / 2;
    Eigen::Array3d low(infinity, infinity, infinity), high(-infinity, -infinity, -infinity);
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d p = point(i);
        const Eigen::Array3d local(p.dot(camera.right), p.dot(camera.up), p.dot(camera.toward));
        low = low.min(local);
        high = high.max(local);
    }
    if (count == 0) {
        low = -1;
        high = 1;
    }
    const Eigen::Array3d middle = (low + high) / 2;
    camera.centre = middle[0] * camera.right + middle[1] * camera.up + middle[2] * camera.toward;
    constexpr double margin = 0.92;   // fraction of the pane that the object may fill
    constexpr double smallest = 0.1;  // objects seen end on are not enlarged further
    const double width = margin * pane_width, height = margin * pane_height;
    if (!perspective) {
        camera.scale = std::min(width / std::max(high[0] - low[0], smallest), height / std::max(high[1] - low[1], smallest));
        return camera;
    }
    const double focal = std::min(pane_width, pane_height) / 2 / half_view;
    double distance = (high[2] - low[2]) / 2 + smallest;
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d p = point(i) - camera.centre;
        const double aside = std::max(std::abs(p.dot(camera.right)) / (width / 2), std::abs(p.dot(camera.up)) / (height / 2));
        distance = std::max(distance, p.dot(camera.toward) + aside * focal);
    }
    camera.distance = distance;
    camera.scale = focal / distance;
    return camera;
}

PictureCamera in_mesh_coordinates(const Camera& camera, const std::array<double, 3>& middle, double unit) {
    const auto direction = [](const Eigen::Vector3d& v) { return Vector(v.x(), v.y(), v.z()); };
    const Point centre(middle[0] + unit * camera.centre.x(), middle[1] + unit * camera.centre.y(),
                       middle[2] + unit * camera.centre.z());
    return {direction(camera.right), direction(camera.up),   direction(camera.toward), centre,
            camera.scale / unit,     camera.distance * unit, camera.middle_x,          camera.middle_y};
}

double mark_size(int width, int height) { return std::clamp(std::min(width, height) / 900.0, 0.4, 8.0); }

}  // namespace detail

PictureCamera::Ray PictureCamera::ray(double x, double y) const {
    const Vector aside = (x - middle_x) / scale * right + (middle_y - y) / scale * up;
    if (distance == 0) return {centre + aside, -toward};
    const Vector direction = aside - distance * toward;
    return {centre + distance * toward, direction / std::sqrt(direction.squared_length())};
}

std::optional<std::array<double, 2>> PictureCamera::project(const Point& point) const {
    const Vector local = point - centre;
    double factor = scale;
    if (distance > 0) {
        const double depth = distance - local * toward;
        if (!(depth > 1e-9 * distance)) return std::nullopt;
        factor *= distance / depth;
    }
    return std::array<double, 2>{middle_x + local * right * factor, middle_y - local * up * factor};
}

std::optional<Point> PictureCamera::eye() const {
    if (distance == 0) return std::nullopt;
    return centre + distance * toward;
}

PictureCamera fit_camera(const Mesh& mesh, const CameraPlan& plan) {
    if (mesh.number_of_vertices() == 0) fail_input("mesh", "has no vertices to show", "give another mesh");
    const bool keep_isolated = mesh.number_of_faces() == 0;
    std::vector<Point> points;
    for (const Vertex v : mesh.vertices())
        if (keep_isolated || !mesh.is_isolated(v)) points.push_back(mesh.point(v));
    const CGAL::Bbox_3 box = bounding_box(mesh);
    std::array<double, 3> middle{};
    double half = 0;
    for (int k = 0; k < 3; ++k) {
        middle[static_cast<std::size_t>(k)] = box.min(k) / 2 + box.max(k) / 2;
        half = std::max(half, box.max(k) / 2 - box.min(k) / 2);
    }
    const double unit = half > 0 ? half : 1;
    const auto local = [&](std::size_t i) {
        const Point& p = points[i];
        return Eigen::Vector3d((p.x() - middle[0]) / unit, (p.y() - middle[1]) / unit, (p.z() - middle[2]) / unit);
    };
    detail::Camera camera =
        detail::fit_camera(points.size(), local, plan.view, plan.up, plan.pane.width, plan.pane.height, plan.perspective);
    camera.scale *= plan.zoom;
    camera.middle_x += plan.pane.left;
    camera.middle_y += plan.pane.top;
    return detail::in_mesh_coordinates(camera, middle, unit);
}

PixelBox plain_pane(int width, int height) {
    const double strip = detail::bar_strip * detail::mark_size(width, height);
    return {0, 0, static_cast<double>(std::max(1, width)), static_cast<double>(std::max(1, static_cast<int>(height - strip)))};
}

}  // namespace ostraka
