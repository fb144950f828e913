#include "select/screen_camera.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/mesh/limits.h"
#include "select/screen.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Throws Error (input) if the object is behind a perspective camera, or around it.
void check_sight(const PictureCamera& camera, const Mesh& mesh, const Point& eye, const std::string& where) {
    const auto seen = [&](Vertex v) { return !mesh.is_isolated(v) && camera.project(mesh.point(v)).has_value(); };
    const auto vertices = mesh.vertices();
    if (std::none_of(vertices.begin(), vertices.end(), seen))
        fail_input(where, "the object lies behind the camera", "exchange the eye and the target, or move the eye back");
    if (is_inside(mesh, eye)) fail_input(where, "the eye lies inside the object", "move it out of the surface");
}

/// A perspective or parallel camera with its centre at the target, directed from the eye.
PictureCamera looking(const selection::Camera& description, const Point& eye, const Point& target, const Vector& up,
                      const std::string& where) {
    const auto& pose = std::get<selection::EyeView>(description.pose);
    const PixelBox& pane = description.pane;
    PictureCamera camera;
    camera.centre = target;
    const Vector offset = eye - target;
    camera.toward = unit_vector(offset);
    if (camera.toward == CGAL::NULL_VECTOR) fail_input(where, "the eye is at the target", "move one of them");
    camera.right = CGAL::cross_product(up, camera.toward);
    if (!(camera.right.squared_length() > 1e-12))
        fail_input(where, "\"up\" points along the view", "give another direction as \"up\"");
    camera.right = unit_vector(camera.right);
    camera.up = CGAL::cross_product(camera.toward, camera.right);
    camera.middle_x = pane.left + pane.width / 2;
    camera.middle_y = pane.top + pane.height / 2;
    if (description.perspective) camera.distance = std::sqrt(offset.squared_length());
    if (pose.angle) {
        const double half = *pose.angle / 2 * pi / 180;
        camera.scale = std::min(pane.width, pane.height) / 2 / std::tan(half) / camera.distance;
    } else {
        camera.scale = pose.pixels_per_unit;
    }
    if (!(camera.scale > 0) || !std::isfinite(camera.scale)) fail_input(where, "the camera's scale is not a number above zero");
    return camera;
}

}  // namespace

ScreenCamera screen_camera(const selection::Camera& description, const Mesh& mesh, const std::array<double, 3>& default_up,
                           const std::function<Point(const selection::Position&)>& place, const std::string& where) {
    ScreenCamera result;
    result.width = description.width;
    result.height = description.height;
    const auto [x, y, z] = description.up.value_or(default_up);
    const Vector up = unit_vector({x, y, z});
    if (up == CGAL::NULL_VECTOR) fail_input(where, "\"up\" has no length", "give a vector that is not zero");
    if (const auto* pose = std::get_if<selection::EyeView>(&description.pose)) {
        const Point target = place(pose->target), eye = place(pose->eye);
        result.camera = looking(description, eye, target, up, where);
        if (description.perspective) check_sight(result.camera, mesh, eye, where);
        return result;
    }
    const auto& fitted = std::get<selection::FittedView>(description.pose);
    result.camera =
        fit_camera(mesh, {fitted.view, {up.x(), up.y(), up.z()}, description.perspective, fitted.zoom, description.pane});
    return result;
}

}  // namespace ostraka
