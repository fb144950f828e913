#include "ostraka/operation/report.h"

#include "ostraka/core/json_build.h"

namespace ostraka {

namespace {

JsonValue type_schema(const Field& field, JsonAllocator& allocator) {
    static constexpr const char* types[]{"boolean", "integer", "number", "string", "number", "string"};  // `any` has no type
    JsonValue schema(rapidjson::kObjectType);
    if (field.type == FieldType::numbers || field.type == FieldType::texts)
        add_members(schema, allocator, "type", "array", "items",
                    json_object(allocator, "type", types[static_cast<std::size_t>(field.type)]));
    else if (field.type != FieldType::any) add_members(schema, allocator, "type", types[static_cast<std::size_t>(field.type)]);
    std::string about = field.title;
    if (!field.unit.empty()) about += (about.empty() ? "in " : ", in ") + field.unit;
    if (!about.empty()) add_members(schema, allocator, "description", about);
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
        Field rest = field;
        rest.key = dot == std::string::npos ? "" : field.key.substr(dot + 1);
        inner[name].push_back(std::move(rest));
    }
    for (const std::string& name : order) {
        const auto& list = inner.at(name);
        add_member(properties, name,
                   list.front().key.empty() ? type_schema(list.front(), allocator) : object_schema(list, allocator), allocator);
    }
    return json_object(allocator, "type", "object", "properties", std::move(properties), "additionalProperties", false);
}

}  // namespace

JsonValue ReportLayout::to_schema(JsonAllocator& allocator) const {
    JsonValue result = object_schema(of_values, allocator);
    JsonValue& properties = result["properties"];
    for (const Table& table : tables) {
        if (table.key.empty()) continue;
        JsonValue list = json_object(allocator, "type", "array");
        if (!table.title.empty()) add_members(list, allocator, "description", table.title);
        add_members(list, allocator, "items", object_schema(table.columns, allocator));
        add_members(properties, allocator, table.key, std::move(list));
    }
    ReportLayout always;
    if (checks) always.values(fields::boolean("sound"), fields::integer("defects"), fields::any("findings"));
    always.values(fields::texts("notes"));
    for (const Field& field : always.of_values) add_members(properties, allocator, field.key, type_schema(field, allocator));
    if (!schema.empty()) {
        add_members(result, allocator, "description", "as " + schema + ".schema.json has it");
        result["additionalProperties"].SetBool(true);
    }
    return result;
}

}  // namespace ostraka
