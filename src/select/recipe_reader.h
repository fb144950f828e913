// Reads recipes.
#pragma once

#include "ostraka/files/json.h"
#include "select/recipe_step.h"

namespace ostraka {

/// Reads a recipe. `folder`: folder to which file names in the recipe are relative. Throws Error (input), with the file `where`
/// and the JSON pointer, for a recipe that is not valid by recipe.schema.json, for steps with members that their action lacks or
/// does not use, and for invalid attributes and expressions (ExpressionReader).
Recipe recipe_from_json(const JsonValue& recipe, const Path& folder, const std::string& where);

}  // namespace ostraka
