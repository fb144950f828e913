// The declaration of a call as JSON.
#include "ostraka/files/json_build.h"
#include "ostraka/framework/inputs.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

/// Adds the rule of an option to a schema or declaration: "minimum" and "maximum", or the allowed names under the key `names`.
void add_rule(JsonValue& object, const Option& option, const char* names, JsonAllocator& allocator) {
    if (const auto* range = std::get_if<Range>(&option.rule))
        add_members(object, allocator, "minimum", range->min, "maximum", range->max);
    if (const auto* choices = std::get_if<Choices>(&option.rule)) add_members(object, allocator, names, choices->names);
}

JsonValue option_schema(const Option& option, JsonAllocator& allocator) {
    const OptionType type = option.type();
    const char* name = type == OptionType::boolean                                   ? "boolean"
                       : type == OptionType::integer || type == OptionType::integers ? "integer"
                       : type == OptionType::number || type == OptionType::numbers   ? "number"
                                                                                     : "string";
    JsonValue schema = json_object(allocator, "type", name);
    add_rule(schema, option, "enum", allocator);
    if (option.is_list()) schema = json_object(allocator, "type", "array", "items", std::move(schema));
    const std::string constraint = std::holds_alternative<Words>(option.rule) ? option.allowed() : option.unit;
    add_members(schema, allocator, "description",
                constraint.empty() ? option.help : fmt::format("{} ({})", option.help, constraint));
    return schema;
}

/// Default value of an option, with its JSON type.
JsonValue initial_of(const Option& option, JsonAllocator& allocator) {
    const OptionType type = option.type();
    if (type == OptionType::boolean) return JsonValue(option.initial == "true");
    if (type == OptionType::integer) return JsonValue(static_cast<std::int64_t>(std::stod(option.initial)));
    if (type == OptionType::number) return JsonValue(std::stod(option.initial));
    return json_string(option.initial, allocator);
}

}  // namespace

JsonValue Call::schema(JsonAllocator& allocator) const {
    JsonValue properties(rapidjson::kObjectType);
    std::vector<std::string> needed;
    for (const Slot* slot : parameters_.slots()) {
        JsonValue slot_schema = slot->repeated
                                    ? json_object(allocator, "type", "array", "items", json_object(allocator, "type", "string"))
                                : slot->role == Role::input ? json_object(allocator, "type", "string")
                                                            : json_object(allocator, "type", std::array{"string", "boolean"});
        add_members(slot_schema, allocator, "description", slot->help);
        add_members(properties, allocator, slot->name, std::move(slot_schema));
        if (slot->needed && slot->role == Role::input && !slot->may_be_new) needed.push_back(slot->name);
    }
    for (const Option& option : parameters_.options) {
        add_members(properties, allocator, option.name, option_schema(option, allocator));
        if (option.needed) needed.push_back(option.name);
    }
    JsonValue schema = json_object(allocator, "$schema", "http://json-schema.org/draft-04/schema#", "title", entry_->name,
                                   "description", entry_->help, "type", "object", "properties", std::move(properties));
    if (!needed.empty()) add_members(schema, allocator, "required", needed);
    add_members(schema, allocator, "additionalProperties", false);
    return schema;
}

JsonValue Call::declaration(JsonAllocator& allocator) const {
    JsonValue inputs(rapidjson::kArrayType), outputs(rapidjson::kArrayType), options(rapidjson::kArrayType);
    for (const Slot* slot : parameters_.slots()) {
        JsonValue slot_entry = json_object(allocator, "name", slot->name, "kind", to_string(slot->kind), "required", slot->needed,
                                           "repeated", slot->repeated);
        if (slot->updated != nullptr) add_members(slot_entry, allocator, "updates", slot->updated->name);
        add_members(slot_entry, allocator, "help", slot->help);
        (slot->role == Role::input ? inputs : outputs).PushBack(slot_entry, allocator);
    }
    for (const Option& option : parameters_.options) {
        static constexpr const char* types[]{"boolean", "integer", "number", "text", "choice", "texts", "numbers", "integers"};
        JsonValue option_entry =
            json_object(allocator, "name", option.name, "type", types[static_cast<std::size_t>(option.type())]);
        add_rule(option_entry, option, "choices", allocator);
        if (const auto* words = std::get_if<Words>(&option.rule))
            add_members(option_entry, allocator, "words", words->names, "others", words->others);
        if (!option.initial.empty()) add_members(option_entry, allocator, "default", initial_of(option, allocator));
        if (!option.unit.empty()) add_members(option_entry, allocator, "unit", option.unit);
        if (!option.group.empty()) add_members(option_entry, allocator, "group", option.group);
        add_members(option_entry, allocator, "required", option.needed, "help", option.help);
        options.PushBack(option_entry, allocator);
    }
    return json_object(allocator, "name", entry_->name, "help", entry_->help, "inputs", std::move(inputs), "outputs",
                       std::move(outputs), "options", std::move(options), "arguments", parameters_.orders, "result",
                       parameters_.report.to_schema(allocator));
}

}  // namespace ostraka
