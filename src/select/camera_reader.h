// Cameras as recipes give them.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/render/camera.h"

#include <functional>
#include <string>

namespace ostraka {

/// A camera and the picture it fills.
struct ScreenCamera {
    PictureCamera camera;
    double width = 1200, height = 900;
};

/// Reads {"view", "up", "projection", "zoom", "picture", "pane"} or {"eye", "target", "angle" or "pixelsPerUnit", ...}.
/// `place` turns a list of three numbers into a point of the mesh, `up` holds where the camera says nothing. Throws Error
/// (input), starting with `where`, for a camera that sees nothing: from inside the object, turned away from it, or degenerate.
ScreenCamera read_camera(const JsonValue& value, const Mesh& mesh, const std::array<double, 3>& up,
                         const std::function<Point(const JsonValue&)>& place, const std::string& where);

}  // namespace ostraka
