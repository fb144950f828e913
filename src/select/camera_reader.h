// Reads the cameras of recipes.
#pragma once

#include "select/expression_reader.h"

#include <string>

namespace ostraka {

/// Reads a camera from JSON: {"view", "up", "projection", "zoom", "picture", "pane"} or {"eye", "target", "angle" or
/// "pixelsPerUnit", ...}, valid by recipe.schema.json. Throws Error (input), starting with the file `where` and the JSON pointer,
/// for an unknown view, a pane outside the picture, and members that are missing or contradict each other.
selection::Camera camera_from_json(const RecipeValue& value, const std::string& where);

}  // namespace ostraka
