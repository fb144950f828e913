#include "ostraka/collection/measure_definitions.h"

#include "ostraka/core/error.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <set>

namespace ostraka {

namespace {

MeasureDirection direction_from(const JsonValue& value, const std::string& where) {
    MeasureDirection direction;
    if (value.IsString()) {
        direction.up = true;
        return direction;
    }
    for (rapidjson::SizeType i = 0; i < 3; ++i) direction.coordinates[i] = value[i].GetDouble();
    const auto& [x, y, z] = direction.coordinates;
    if (unit_vector({x, y, z}) == CGAL::NULL_VECTOR)
        fail_input(where, "the direction has length zero", "give three numbers of which at least one is not 0");
    return direction;
}

MeasurePlace place_from(const JsonValue& value, const std::string& where) {
    if (value.IsString()) return {value.GetString(), std::nullopt};
    return {value["annotation"].GetString(), direction_from(value["extreme"], where)};
}

}  // namespace

MeasureDefinitions measure_definitions_from_text(const std::string& text, const std::string& where) {
    const Json document = parse_json(text, where);
    validate(document, "measures", where);
    MeasureDefinitions result;
    result.text = text;
    std::set<std::string> names;
    const auto& entries = document["measures"].GetArray();
    for (rapidjson::SizeType i = 0; i < entries.Size(); ++i) {
        const JsonValue& entry = entries[i];
        const std::string at = fmt::format("{}, /measures/{}", where, i);
        const auto word = [&](const char* name) {
            const JsonValue* member = find_member(entry, name);
            return member == nullptr ? std::string() : std::string(member->GetString());
        };
        MeasureDefinition definition;
        definition.name = word("name");
        if (!names.insert(definition.name).second)
            fail_input(at, fmt::format("two measures have the name '{}'", definition.name), "give each measure its own name");
        definition.tool = word("tool");
        definition.annotation = word("annotation");
        definition.attribute = word("attribute");
        definition.descriptor = word("descriptor");
        definition.clay = word("clay");
        definition.exact = word("geodesic") == "exact";
        if (const JsonValue* number = find_member(entry, "entry")) definition.entry = number->GetInt();
        if (const JsonValue* direction = find_member(entry, "direction"))
            definition.direction = direction_from(*direction, at + "/direction");
        if (entry.HasMember("from")) {
            definition.pins.push_back(place_from(entry["from"], at + "/from"));
            if (const JsonValue* via = find_member(entry, "via"))
                for (const JsonValue& place : via->GetArray()) definition.pins.push_back(place_from(place, at + "/via"));
            definition.pins.push_back(place_from(entry["to"], at + "/to"));
        }
        result.measures.push_back(std::move(definition));
    }
    return result;
}

MeasureDefinitions read_measure_definitions(const Path& file) {
    return measure_definitions_from_text(read_file(file), file.string());
}

}  // namespace ostraka
