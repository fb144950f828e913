#include "select/camera_reader.h"

#include "ostraka/core/error.h"

namespace ostraka {

namespace {

bool has(const JsonValue& object, const char* name) { return find_member(object, name) != nullptr; }

PixelBox pane_of(const JsonValue& value, int width, int height, const std::string& where) {
    PixelBox pane = plain_pane(width, height);
    if (const JsonValue* own = find_member(value, "pane"))
        pane = {(*own)[0].GetDouble(), (*own)[1].GetDouble(), (*own)[2].GetDouble(), (*own)[3].GetDouble()};
    if (!(pane.width > 0) || !(pane.height > 0)) fail_input(where, "the pane has no area", "give [left, top, width, height]");
    if (pane.left >= width || pane.top >= height || pane.left + pane.width <= 0 || pane.top + pane.height <= 0)
        fail_input(where, "the pane lies outside the picture", "give [left, top, width, height] in the picture's pixels");
    return pane;
}

selection::EyeView eye_view_of(const RecipeValue& value, bool perspective, const std::string& where) {
    const JsonValue& json = value.json;
    for (const char* name : {"view", "zoom"})
        if (has(json, name)) fail_input(where, std::string("a camera with both an eye and \"") + name + "\"", "give one of them");
    if (!has(json, "target"))
        fail_input(where, "a camera with an eye but without a target", "say what it looks at: \"target\": [x, y, z]");
    selection::EyeView pose{{triple_of(json["eye"]), value.frame}, {triple_of(json["target"]), value.frame}, {}, 1};
    pose.angle = number_in(json, "angle");
    const bool by_angle = pose.angle.has_value();
    if (by_angle == has(json, "pixelsPerUnit"))
        fail_input(
            where,
            by_angle ? "a camera with both an angle and pixelsPerUnit" : "a camera with neither an angle nor pixelsPerUnit",
            "give one of them");
    if (by_angle && !perspective)
        fail_input(where, "parallel rays have no angle", "give pixelsPerUnit, or take a perspective camera");
    pose.pixels_per_unit = number_or(json, "pixelsPerUnit", pose.pixels_per_unit);
    return pose;
}

selection::FittedView fitted_view_of(const JsonValue& value, const std::string& where) {
    for (const char* name : {"target", "angle", "pixelsPerUnit"})
        if (has(value, name))
            fail_input(where, std::string("a camera with \"") + name + "\" but without an eye",
                       "give \"eye\", or a \"view\" alone");
    const JsonValue* view = find_member(value, "view");
    try {
        return {parse_view(view == nullptr ? "30,20" : text_of(*view)), number_or(value, "zoom", 1)};
    } catch (const Error& error) {
        fail_input(where, error.problem(), error.remedy());
    }
}

}  // namespace

selection::Camera camera_from_json(const RecipeValue& value, const std::string& file) {
    const std::string where = file + ", at " + value.at;
    const JsonValue& json = value.json;
    selection::Camera camera;
    camera.at = value.at;
    if (const JsonValue* picture = find_member(json, "picture")) {
        camera.width = (*picture)[0].GetInt();
        camera.height = (*picture)[1].GetInt();
    }
    camera.pane = pane_of(json, camera.width, camera.height, where);
    if (const JsonValue* up = find_member(json, "up")) camera.up = triple_of(*up);
    camera.perspective = text_in(json, "projection") == "perspective";
    const RecipeValue own{json, frame_of(json, value.frame), value.at};
    if (has(json, "eye")) camera.pose = eye_view_of(own, camera.perspective, where);
    else camera.pose = fitted_view_of(json, where);
    return camera;
}

}  // namespace ostraka
