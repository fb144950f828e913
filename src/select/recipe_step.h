// A step of a recipe.
#pragma once

#include "select/expression.h"

#include <array>
#include <optional>
#include <string>

namespace ostraka {

/// Where the outline of a selected region runs.
enum class StepOutline {
    drawn,  ///< free if part of the border is a level of a field; sets of faces end along the edges of the mesh
    edges,
    free,  ///< always free: sets of faces end at isolines
};

enum class StepAction { make, add_to, remove_from, replace, erase, retag };
/// As in recipes: "make", "add to", "remove from", "replace", "delete", "retag".
std::string to_string(StepAction action);

/// What a step of a recipe makes of one annotation. The recipe must outlive it.
struct RecipeStep {
    std::string at;  ///< JSON pointer of the step
    int id = 0;
    StepAction action = StepAction::make;
    PlaceFrame frame;
    StepOutline outline = StepOutline::drawn;
    std::optional<std::string> tag;
    std::optional<AnnotationType> type;
    std::optional<std::array<int, 3>> colour;
    const JsonValue* select = nullptr;      ///< the selection expression
    const JsonValue* attributes = nullptr;  ///< as in annotation files, but see doc/recipes.md

    [[nodiscard]] bool selects() const { return action != StepAction::erase && action != StepAction::retag; }
};

/// Reads a step of a valid recipe (recipe.schema.json). `around`: the recipe's frame. Throws Error (input), with the file `where`
/// and the JSON pointer, for members that the action lacks or does not use.
RecipeStep recipe_step_from_json(const JsonValue& step, PlaceFrame around, const std::string& where, const std::string& at);

}  // namespace ostraka
