#include "select/recipe_step.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

constexpr const char* action_names[]{"make", "add to", "remove from", "replace", "delete", "retag"};

AnnotationType annotation_type(const std::string& name) {
    return name == "point" ? AnnotationType::point : name == "line" ? AnnotationType::line : AnnotationType::region;
}

StepAction action_of(const std::string& name) {
    const auto found = std::find(std::begin(action_names), std::end(action_names), name);
    return found == std::end(action_names) ? StepAction::make : static_cast<StepAction>(found - std::begin(action_names));
}

void check_new(const RecipeStep& step, const std::string& where) {
    const auto need = [&](bool given, const char* name) {
        if (!given)
            fail_input(where, fmt::format("at {}: a new annotation without \"{}\"", step.at, name),
                       "add it, or name the action that edits an older one");
    };
    need(step.tag.has_value(), "tag");
    need(step.type.has_value(), "type");
    need(step.select != nullptr, "select");
}

}  // namespace

std::string to_string(StepAction action) { return action_names[static_cast<std::size_t>(action)]; }

RecipeStep recipe_step_from_json(const JsonValue& step, PlaceFrame around, const std::string& where, const std::string& at) {
    RecipeStep result;
    result.at = at;
    result.id = step["id"].GetInt();
    result.action = action_of(text_in(step, "action"));
    result.frame = ExpressionEvaluator::frame_of(step, around);
    const std::string outline = text_in(step, "outline");
    if (!outline.empty()) result.outline = outline == "free" ? StepOutline::free : StepOutline::edges;
    if (const JsonValue* tag = find_member(step, "tag")) result.tag = text_of(*tag);
    if (const JsonValue* type = find_member(step, "type")) result.type = annotation_type(text_of(*type));
    if (const JsonValue* colour = find_member(step, "colour"))
        result.colour = {(*colour)[0].GetInt(), (*colour)[1].GetInt(), (*colour)[2].GetInt()};
    result.select = find_member(step, "select");
    result.attributes = find_member(step, "attributes");
    if (result.action == StepAction::make) check_new(result, where);
    return result;
}

}  // namespace ostraka
