// A step of a recipe.
#pragma once

#include "select/expression.h"

#include <array>
#include <optional>
#include <string>

namespace ostraka {

/// Course of the outline of a selected region.
enum class StepOutline {
    drawn,  ///< a free outline if part of the border is a level of a field; sets of faces end along the edges of the mesh
    edges,  ///< along the edges of the mesh
    free,   ///< always a free outline: sets of faces end at isolines
};

enum class StepAction { make, add_to, remove_from, replace, erase, retag };  ///< what a step does with an annotation
/// Name of an action in recipes: "make", "add to", "remove from", "replace", "delete", "retag".
std::string to_string(StepAction action);

/// What a step of a recipe does with one annotation. The recipe must outlive the step.
struct RecipeStep {
    std::string at;  ///< JSON pointer of the step
    int id = 0;      ///< id of the annotation
    StepAction action = StepAction::make;
    PlaceFrame frame;  ///< coordinate system of the step
    StepOutline outline = StepOutline::drawn;
    std::optional<std::string> tag;  ///< tag, type and colour that the step states; empty: not stated
    std::optional<AnnotationType> type;
    std::optional<std::array<int, 3>> colour;
    const JsonValue* select = nullptr;  ///< selection expression; null: the step selects nothing
    /// Attributes in the form of annotation files, with the additions in doc/recipes.md; null: none.
    const JsonValue* attributes = nullptr;

    /// Whether the action has a selection expression.
    [[nodiscard]] bool selects() const { return action != StepAction::erase && action != StepAction::retag; }
};

/// Reads a step of a valid recipe (recipe.schema.json). `around`: the recipe's coordinate system. Throws Error (input), with the
/// file `where` and the JSON pointer `at`, for members that the action lacks or does not use.
RecipeStep recipe_step_from_json(const JsonValue& step, PlaceFrame around, const std::string& where, const std::string& at);

}  // namespace ostraka
