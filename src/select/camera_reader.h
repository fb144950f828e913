// Reads the cameras of recipes.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/render/camera.h"

#include <functional>
#include <string>

namespace ostraka {

/// A camera and the size of its picture in pixels.
struct ScreenCamera {
    PictureCamera camera;
    double width = 1200, height = 900;
};

/// Reads a camera from JSON: {"view", "up", "projection", "zoom", "picture", "pane"} or {"eye", "target", "angle" or
/// "pixelsPerUnit", ...}. `place` converts a list of three numbers to a point of the mesh; `up`: default upward direction. Throws
/// Error (input), starting with `where`, for a camera that cannot see the object: inside the object, turned away from it, or
/// degenerate.
ScreenCamera read_camera(const JsonValue& value, const Mesh& mesh, const std::array<double, 3>& up,
                         const std::function<Point(const JsonValue&)>& place, const std::string& where);

}  // namespace ostraka
