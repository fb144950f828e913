#include "select/camera_reader.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/mesh/limits.h"
#include "select/screen.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// A perspective or parallel camera at the eye, directed at the target.
PictureCamera looking(const JsonValue& value, const Mesh& mesh, const Vector& up, bool perspective, const PixelBox& pane,
                      const std::function<Point(const JsonValue&)>& place, const std::string& where) {
    const JsonValue* target = find_member(value, "target");
    if (target == nullptr)
        fail_input(where, "a camera with an eye but without a target", "say what it looks at: \"target\": [x, y, z]");
    PictureCamera camera;
    camera.centre = place(*target);
    const Point eye = place(value["eye"]);
    const Vector offset = eye - camera.centre;
    camera.toward = unit_vector(offset);
    if (camera.toward == CGAL::NULL_VECTOR) fail_input(where, "the eye is at the target", "move one of them");
    camera.right = CGAL::cross_product(up, camera.toward);
    if (!(camera.right.squared_length() > 1e-12))
        fail_input(where, "\"up\" points along the view", "give another direction as \"up\"");
    camera.right = unit_vector(camera.right);
    camera.up = CGAL::cross_product(camera.toward, camera.right);
    camera.middle_x = pane.left + pane.width / 2;
    camera.middle_y = pane.top + pane.height / 2;
    if (perspective) camera.distance = std::sqrt(offset.squared_length());
    const bool by_angle = find_member(value, "angle") != nullptr;
    if (by_angle == (find_member(value, "pixelsPerUnit") != nullptr))
        fail_input(
            where,
            by_angle ? "a camera with both an angle and pixelsPerUnit" : "a camera with neither an angle nor pixelsPerUnit",
            "give one of them");
    if (by_angle && !perspective)
        fail_input(where, "parallel rays have no angle", "give pixelsPerUnit, or take a perspective camera");
    if (by_angle) {
        const double half = number_or(value, "angle", 30) / 2 * pi / 180;
        camera.scale = std::min(pane.width, pane.height) / 2 / std::tan(half) / camera.distance;
    } else {
        camera.scale = number_or(value, "pixelsPerUnit", 1);
    }
    if (!(camera.scale > 0) || !std::isfinite(camera.scale)) fail_input(where, "the camera's scale is not a number above zero");
    if (perspective) {
        const auto seen = [&](Vertex v) { return !mesh.is_isolated(v) && camera.project(mesh.point(v)).has_value(); };
        const auto vertices = mesh.vertices();
        if (std::none_of(vertices.begin(), vertices.end(), seen))
            fail_input(where, "the object lies behind the camera", "exchange the eye and the target, or move the eye back");
        if (is_inside(mesh, eye)) fail_input(where, "the eye lies inside the object", "move it out of the surface");
    }
    return camera;
}

}  // namespace

ScreenCamera read_camera(const JsonValue& value, const Mesh& mesh, const std::array<double, 3>& default_up,
                         const std::function<Point(const JsonValue&)>& place, const std::string& where) {
    ScreenCamera result;
    int width = 1200, height = 900;
    if (const JsonValue* picture = find_member(value, "picture")) {
        width = (*picture)[0].GetInt();
        height = (*picture)[1].GetInt();
    }
    result.width = width;
    result.height = height;
    CameraPlan plan;
    plan.pane = plain_pane(width, height);
    if (const JsonValue* pane = find_member(value, "pane"))
        plan.pane = {(*pane)[0].GetDouble(), (*pane)[1].GetDouble(), (*pane)[2].GetDouble(), (*pane)[3].GetDouble()};
    if (!(plan.pane.width > 0) || !(plan.pane.height > 0))
        fail_input(where, "the pane has no area", "give [left, top, width, height]");
    if (plan.pane.left >= width || plan.pane.top >= height || plan.pane.left + plan.pane.width <= 0 ||
        plan.pane.top + plan.pane.height <= 0)
        fail_input(where, "the pane lies outside the picture", "give [left, top, width, height] in the picture's pixels");
    const JsonValue* own = find_member(value, "up");
    const auto [x, y, z] = own == nullptr ? default_up : triple_of(*own);
    const Vector up = unit_vector({x, y, z});
    if (up == CGAL::NULL_VECTOR) fail_input(where, "\"up\" has no length", "give a vector that is not zero");
    plan.perspective = text_in(value, "projection") == "perspective";
    const bool has_eye = find_member(value, "eye") != nullptr;
    for (const char* name : {"target", "angle", "pixelsPerUnit"})
        if (!has_eye && find_member(value, name) != nullptr)
            fail_input(where, std::string("a camera with \"") + name + "\" but without an eye",
                       "give \"eye\", or a \"view\" alone");
    for (const char* name : {"view", "zoom"})
        if (has_eye && find_member(value, name) != nullptr)
            fail_input(where, std::string("a camera with both an eye and \"") + name + "\"", "give one of them");
    if (has_eye) {
        result.camera = looking(value, mesh, up, plan.perspective, plan.pane, place, where);
        return result;
    }
    const JsonValue* view = find_member(value, "view");
    try {
        plan.view = parse_view(view == nullptr ? "30,20" : text_of(*view));
    } catch (const Error& error) {
        fail_input(where, error.problem(), error.remedy());
    }
    plan.up = {up.x(), up.y(), up.z()};
    plan.zoom = number_or(value, "zoom", 1);
    result.camera = fit_camera(mesh, plan);
    return result;
}

}  // namespace ostraka
