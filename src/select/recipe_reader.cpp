#include "select/recipe_reader.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/select/recipe.h"
#include "select/expression_reader.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

constexpr std::pair<const char*, StepAction> actions[]{
    {"make", StepAction::make},       {"add to", StepAction::add_to}, {"remove from", StepAction::remove_from},
    {"replace", StepAction::replace}, {"delete", StepAction::erase},  {"retag", StepAction::retag}};

std::optional<std::string> optional_text(const JsonValue& object, const char* name) {
    const JsonValue* found = find_member(object, name);
    return found == nullptr ? std::nullopt : std::optional(text_of(*found));
}

AnnotationType annotation_type(const std::string& name) {
    return name == "point" ? AnnotationType::point : name == "line" ? AnnotationType::line : AnnotationType::region;
}

/// Reads the steps of one recipe.
class StepReader {
public:
    StepReader(ExpressionReader expressions, std::string where)
        : expressions_(std::move(expressions)), where_(std::move(where)) {}

    RecipeStep step(const RecipeValue& value) {
        const JsonValue& json = value.json;
        RecipeStep step;
        step.at = value.at;
        step.id = json["id"].GetInt();
        const std::string action = optional_text(json, "action").value_or("make");
        for (const auto& [name, meaning] : actions)
            if (name == action) step.action = meaning;
        if (const auto outline = optional_text(json, "outline"))
            step.outline = *outline == "free" ? StepOutline::free : StepOutline::edges;
        step.tag = optional_text(json, "tag");
        if (const auto type = optional_text(json, "type")) step.type = annotation_type(*type);
        if (const JsonValue* colour = find_member(json, "colour"))
            step.colour = {(*colour)[0].GetInt(), (*colour)[1].GetInt(), (*colour)[2].GetInt()};
        if (step.action == StepAction::make) check_new(value);
        else check_edit(value, action, step.action);
        const RecipeValue inner{json, frame_of(json, value.frame), value.at};
        if (find_member(json, "select") != nullptr) step.select = expressions_.expression(inner["select"]);
        if (find_member(json, "attributes") != nullptr) step.attributes = attributes(inner["attributes"]);
        return step;
    }

private:
    void check_new(const RecipeValue& step) const {
        for (const char* name : {"tag", "type", "select"})
            if (find_member(step.json, name) == nullptr)
                expressions_.fail(step.at, fmt::format("a new annotation without \"{}\"", name),
                                  "add it, or name the action that edits an older one");
    }

    /// Checks that the members of a step suit its action.
    void check_edit(const RecipeValue& step, const std::string& name, StepAction action) const {
        const auto has = [&](const char* member) { return find_member(step.json, member) != nullptr; };
        const bool selects = action != StepAction::erase && action != StepAction::retag;
        if (selects && !has("select"))
            expressions_.fail(step.at, fmt::format("the action '{}' without \"select\"", name), "say what to " + name);
        if (!selects && has("select"))
            expressions_.fail(step.at + "/select", fmt::format("the action '{}' selects nothing", name), "leave it out");
        for (const char* member : {"tag", "colour", "attributes"})
            if (action == StepAction::erase && has(member))
                expressions_.fail(step.at + '/' + member, "the action 'delete' keeps nothing", "leave it out");
        if (action == StepAction::retag && !has("tag") && !has("colour") && !has("attributes"))
            expressions_.fail(step.at, "the action 'retag' changes nothing", "give a tag, a colour or attributes");
    }

    /// Attributes are written as in annotation files, except that pins may be given by coordinates, and that a bounding measure
    /// may omit its pins.
    std::vector<StepAttribute> attributes(const RecipeValue& value) {
        Json list;
        list.CopyFrom(value.json, list.GetAllocator());
        std::vector<std::vector<selection::Pick>> pins(list.Size());
        for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
            const auto measure = list[i].FindMember("measure");
            if (measure == list[i].MemberEnd()) continue;
            const RecipeValue given = value[i]["measure"];
            if (find_member(given.json, "points") != nullptr) pins[i] = expressions_.picks(given["points"]);
            else if (find_member(given.json, "direction") == nullptr)
                expressions_.fail(given.at, "a measure with neither points nor a direction",
                                  "give its pins, or the direction of a bounding measure");
            while (measure->value.RemoveMember("points")) {
            }
        }
        std::vector<StepAttribute> result;
        for (Attribute& attribute : attributes_from_json(list, where_, value.at))
            result.push_back({std::move(attribute), std::move(pins[result.size()])});
        return result;
    }

    ExpressionReader expressions_;
    std::string where_;
};

void collect_maps(const JsonValue& value, const Path& folder, std::vector<Path>& files) {
    if (value.IsArray())
        for (const auto& item : value.GetArray()) collect_maps(item, folder, files);
    if (!value.IsObject()) return;
    for (const auto& member : value.GetObject()) {
        if (std::string(member.name.GetString()) == "threshold" && member.value.IsObject())
            if (const JsonValue* map = find_member(member.value, "map"); map != nullptr && map->IsString()) {
                const Path file = file_inside(text_of(*map), folder, "", "threshold/map", "the recipe's folder",
                                              "move the map beside the recipe");
                if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
            }
        collect_maps(member.value, folder, files);
    }
}

}  // namespace

Recipe recipe_from_json(const JsonValue& json, const Path& folder, const std::string& where) {
    check_format(json, "ostraka-recipe", where, "give a recipe ('ostraka-recipe')");
    validate(json, "recipe", where);
    const PlaceFrame frame = frame_of(json, PlaceFrame{});
    StepReader reader(ExpressionReader(where, folder, find_member(json, "cameras"), frame), where);
    Recipe recipe;
    recipe.object_class = optional_text(json, "class");
    recipe.unit = optional_text(json, "unit");
    if (const JsonValue* up = find_member(json, "up")) recipe.up = triple_of(*up);
    const RecipeValue steps = RecipeValue{json, frame, ""}["annotations"];
    for (rapidjson::SizeType i = 0; i < steps.json.Size(); ++i) recipe.steps.push_back(reader.step(steps[i]));
    return recipe;
}

std::vector<Path> files_named_by(const JsonValue& recipe, const Path& folder) {
    std::vector<Path> files;
    collect_maps(recipe, folder, files);
    return files;
}

}  // namespace ostraka
