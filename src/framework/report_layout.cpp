#include "ostraka/framework/report.h"

#include "ostraka/files/json_build.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

JsonValue type_schema(const Field& field, JsonAllocator& allocator) {
    static constexpr const char* types[]{"boolean", "integer", "number", "string", "number", "string"};  // `any` has no type
    JsonValue schema(rapidjson::kObjectType);
    if (field.type == FieldType::numbers || field.type == FieldType::texts)
        add_members(schema, allocator, "type", "array", "items",
                    json_object(allocator, "type", types[static_cast<std::size_t>(field.type)]));
    else if (field.type != FieldType::any) add_members(schema, allocator, "type", types[static_cast<std::size_t>(field.type)]);
    std::string description = field.title;
    if (!field.unit.empty()) description += (description.empty() ? "in " : ", in ") + field.unit;
    if (!description.empty()) add_members(schema, allocator, "description", description);
    return schema;
}

/// JSON schema of an object with these fields; dots in keys separate nested members.
JsonValue object_schema(const std::vector<Field>& fields, JsonAllocator& allocator) {
    JsonValue properties(rapidjson::kObjectType);
    std::map<std::string, std::vector<Field>> inner;
    std::vector<std::string> order;
    for (const Field& field : fields) {
        if (field.key.empty()) continue;
        const std::size_t dot = field.key.find('.');
        const std::string name = field.key.substr(0, dot);
        if (inner.find(name) == inner.end()) order.push_back(name);
        Field inner_field = field;
        inner_field.key = dot == std::string::npos ? "" : field.key.substr(dot + 1);
        inner[name].push_back(std::move(inner_field));
    }
    for (const std::string& name : order) {
        const auto& inner_fields = inner.at(name);
        add_member(properties, name,
                   inner_fields.front().key.empty() ? type_schema(inner_fields.front(), allocator)
                                                    : object_schema(inner_fields, allocator),
                   allocator);
    }
    return json_object(allocator, "type", "object", "properties", std::move(properties), "additionalProperties", false);
}

}  // namespace

JsonValue ReportLayout::to_schema(JsonAllocator& allocator) const {
    JsonValue result = object_schema(value_fields, allocator);
    JsonValue& properties = result["properties"];
    for (const Table& table : tables) {
        if (table.key.empty()) continue;
        JsonValue table_schema = json_object(allocator, "type", "array");
        if (!table.title.empty()) add_members(table_schema, allocator, "description", table.title);
        add_members(table_schema, allocator, "items", object_schema(table.columns, allocator));
        add_members(properties, allocator, table.key, std::move(table_schema));
    }
    ReportLayout common;
    if (checks) common.values(fields::boolean("sound"), fields::integer("defects"), fields::any("findings"));
    common.values(fields::texts("notes"));
    for (const Field& field : common.value_fields) add_members(properties, allocator, field.key, type_schema(field, allocator));
    if (!schema.empty()) {
        add_members(result, allocator, "description", fmt::format("as specified by {}.schema.json", schema));
        result["additionalProperties"].SetBool(true);
    }
    return result;
}

}  // namespace ostraka
