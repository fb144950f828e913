// Cameras of recipes, placed before a mesh.
#pragma once

#include "select/expression.h"

#include <functional>
#include <string>

namespace ostraka {

/// A camera and the size of its picture in pixels.
struct ScreenCamera {
    PictureCamera camera;
    double width = 1200, height = 900;
};

/// Places a camera before the mesh. `place` gives the point of a position; `up`: upward direction for cameras that state none.
/// Throws Error (input), starting with `where`, for a camera that cannot see the object: inside the object, turned away from it,
/// or degenerate.
ScreenCamera screen_camera(const selection::Camera& camera, const Mesh& mesh, const std::array<double, 3>& up,
                           const std::function<Point(const selection::Position&)>& place, const std::string& where);

}  // namespace ostraka
