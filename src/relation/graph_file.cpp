// *.graph.json
#include "ostraka/core/error.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

namespace {

std::array<double, 3> vector_of(const JsonValue& list) { return {list[0].GetDouble(), list[1].GetDouble(), list[2].GetDouble()}; }

JsonValue numbers_of(const std::array<double, 3>& numbers, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const double number : numbers) list.PushBack(number, allocator);
    return list;
}

PointAndDirection line_of(const JsonValue& object, const char* direction) {
    return {vector_of(object["point"]), vector_of(object[direction])};
}

std::string text_of(const JsonValue& object, const char* name) {
    const JsonValue* member = find_member(object, name);
    return member == nullptr ? "" : std::string(member->GetString(), member->GetStringLength());
}

RelationParameters parameters_from(const JsonValue& object) {
    RelationParameters parameters;
    if (const JsonValue* list = find_member(object, "deviations"))
        for (const auto& entry : list->GetArray()) {
            Deviation deviation{text_of(entry, "quantity"), {}, {}, text_of(entry, "unit")};
            if (const JsonValue* value = find_member(entry, "value")) deviation.value = value->GetDouble();
            if (const JsonValue* tolerance = find_member(entry, "tolerance")) deviation.tolerance = tolerance->GetDouble();
            parameters.deviations.push_back(std::move(deviation));
        }
    if (const JsonValue* plane = find_member(object, "plane")) parameters.plane = line_of(*plane, "normal");
    if (const JsonValue* axis = find_member(object, "axis")) parameters.axis = line_of(*axis, "direction");
    if (const JsonValue* up = find_member(object, "up")) parameters.up = vector_of(*up);
    parameters.attribute = text_of(object, "attribute");
    return parameters;
}

JsonValue json_of(const PointAndDirection& line, const char* direction, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    add_member(object, "point", numbers_of(line.point, allocator), allocator);
    add_member(object, direction, numbers_of(line.direction, allocator), allocator);
    return object;
}

JsonValue json_of(const RelationParameters& parameters, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    if (!parameters.attribute.empty()) add_member(object, "attribute", parameters.attribute, allocator);
    if (!parameters.deviations.empty()) {
        JsonValue list(rapidjson::kArrayType);
        for (const auto& deviation : parameters.deviations) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "quantity", deviation.quantity, allocator);
            if (deviation.value) add_member(entry, "value", JsonValue(*deviation.value), allocator);
            if (deviation.tolerance) add_member(entry, "tolerance", JsonValue(*deviation.tolerance), allocator);
            if (!deviation.unit.empty()) add_member(entry, "unit", deviation.unit, allocator);
            list.PushBack(entry, allocator);
        }
        add_member(object, "deviations", std::move(list), allocator);
    }
    if (parameters.plane) add_member(object, "plane", json_of(*parameters.plane, "normal", allocator), allocator);
    if (parameters.axis) add_member(object, "axis", json_of(*parameters.axis, "direction", allocator), allocator);
    if (parameters.up) add_member(object, "up", numbers_of(*parameters.up, allocator), allocator);
    return object;
}

}  // namespace

RelationGraph graph_from_json(const JsonValue& document, const AnnotationSet& set, const std::string& where) {
    validate(document, "graph", where);
    RelationGraph graph;
    for (const auto& entry : document["relationships"].GetArray()) {
        Relationship relationship;
        relationship.id = entry["id"].GetInt();
        relationship.type = text_of(entry, "type");
        if (const RelationType* type = find_relation_type(relationship.type)) relationship.type = type->name;
        relationship.directed = entry["isDirected"].GetBool();
        for (const auto& id : entry["annotations"].GetArray()) relationship.annotations.push_back(id.GetInt());
        relationship.is_constraint = entry["isConstraint"].GetBool();
        if (const JsonValue* weight = find_member(entry, "weight")) relationship.weight = weight->GetDouble();
        if (const JsonValue* constraint = find_member(entry, "constraint"))
            if (!constraint->ObjectEmpty()) relationship.constraint = to_text(*constraint);
        relationship.origin = text_of(entry, "origin");
        if (const JsonValue* parameters = find_member(entry, "parameters"))
            relationship.parameters = parameters_from(*parameters);
        graph.relationships.push_back(std::move(relationship));
    }
    if (const JsonValue* provenance = find_member(document, "provenance"))
        graph.provenance.CopyFrom(*provenance, graph.provenance.GetAllocator());
    check_graph(graph, set, where);
    return graph;
}

RelationGraph read_graph(const Path& file, const AnnotationSet& set) {
    return graph_from_json(read_json(file), set, file.string());
}

JsonValue relationship_to_json(const Relationship& relationship, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType), members(rapidjson::kArrayType);
    add_member(object, "id", JsonValue(relationship.id), allocator);
    add_member(object, "type", relationship.type, allocator);
    add_member(object, "isDirected", JsonValue(relationship.directed), allocator);
    for (const int id : relationship.annotations) members.PushBack(id, allocator);
    add_member(object, "annotations", std::move(members), allocator);
    add_member(object, "isConstraint", JsonValue(relationship.is_constraint), allocator);
    if (relationship.is_constraint) {
        add_member(object, "weight", JsonValue(relationship.weight), allocator);
        JsonValue constraint(rapidjson::kObjectType);
        if (!relationship.constraint.empty()) constraint.CopyFrom(parse_json(relationship.constraint, "constraint"), allocator);
        add_member(object, "constraint", std::move(constraint), allocator);
    }
    if (!relationship.origin.empty()) add_member(object, "origin", relationship.origin, allocator);
    if (!relationship.parameters.empty())
        add_member(object, "parameters", json_of(relationship.parameters, allocator), allocator);
    return object;
}

Json graph_to_json(const RelationGraph& graph, const Provenance& provenance) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-graph", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    JsonValue list(rapidjson::kArrayType);
    for (const auto& relationship : graph.relationships) list.PushBack(relationship_to_json(relationship, allocator), allocator);
    add_member(document, "relationships", std::move(list), allocator);
    add_member(document, "provenance", provenance.to_json(allocator), allocator);
    return document;
}

void write_graph(const Path& file, const RelationGraph& graph, const AnnotationSet& set, const Provenance& provenance) {
    check_graph(graph, set, file.filename().string());
    write_json(file, graph_to_json(graph, provenance));
}

}  // namespace ostraka
