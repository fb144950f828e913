// A recipe and its steps, as typed values; recipe_reader.h reads them.
#pragma once

#include "select/expression.h"

#include "ostraka/annotation/annotation.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Course of the outline of a selected region.
enum class StepOutline {
    drawn,  ///< a free outline if part of the border is a level of a field; sets of faces end along the edges of the mesh
    edges,  ///< along the edges of the mesh
    free,   ///< always a free outline: sets of faces end at isolines
};

enum class StepAction { make, add_to, remove_from, replace, erase, retag };  ///< what a step does with an annotation

/// An attribute of a step.
struct StepAttribute {
    Attribute attribute;                ///< without the pins of its measure
    std::vector<selection::Pick> pins;  ///< pins of a measure; empty: the outermost vertices along the measure's direction
};

/// What a step of a recipe does with one annotation.
struct RecipeStep {
    std::string at;  ///< JSON pointer of the step
    int id = 0;      ///< id of the annotation
    StepAction action = StepAction::make;
    StepOutline outline = StepOutline::drawn;
    std::optional<std::string> tag;  ///< tag, type and colour that the step states; empty: not stated; new ones have tag and type
    std::optional<AnnotationType> type;
    std::optional<std::array<int, 3>> colour;
    std::optional<SelectionExpression> select;             ///< none for the actions erase and retag
    std::optional<std::vector<StepAttribute>> attributes;  ///< attributes to set; none: not stated
};

/// A recipe.
struct Recipe {
    std::optional<std::string> object_class;  ///< class of the object; none: not stated
    std::optional<std::string> unit;          ///< unit of the coordinates; none: not stated
    std::optional<std::array<double, 3>> up;  ///< upward direction of the object; none: not stated
    std::vector<RecipeStep> steps;
};

}  // namespace ostraka
