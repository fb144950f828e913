// Reading and writing *.graph.json.
#include "ostraka/files/json_build.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

namespace {

PointAndDirection line_of(const JsonValue& object, const char* direction) {
    return {triple_of(object["point"]), triple_of(object[direction])};
}

RelationParameters parameters_from(const JsonValue& object) {
    RelationParameters parameters;
    for (const auto& entry : list_in(object, "deviations"))
        parameters.deviations.push_back(
            {text_in(entry, "quantity"), number_in(entry, "value"), number_in(entry, "tolerance"), text_in(entry, "unit")});
    if (const JsonValue* plane = find_member(object, "plane")) parameters.plane = line_of(*plane, "normal");
    if (const JsonValue* axis = find_member(object, "axis")) parameters.axis = line_of(*axis, "direction");
    if (const JsonValue* up = find_member(object, "up")) parameters.up = triple_of(*up);
    parameters.attribute = text_in(object, "attribute");
    return parameters;
}

JsonValue json_of(const PointAndDirection& line, const char* direction, JsonAllocator& allocator) {
    return json_object(allocator, "point", line.point, direction, line.direction);
}

JsonValue json_of(const RelationParameters& parameters, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    JsonValue deviations = json_list(parameters.deviations, allocator, [&](const Deviation& deviation) {
        JsonValue entry = json_object(allocator, "quantity", deviation.quantity);
        add_nonempty_members(entry, allocator, "value", deviation.value, "tolerance", deviation.tolerance, "unit",
                             deviation.unit);
        return entry;
    });
    add_nonempty_members(object, allocator, "attribute", parameters.attribute, "deviations", std::move(deviations));
    if (parameters.plane) add_member(object, "plane", json_of(*parameters.plane, "normal", allocator), allocator);
    if (parameters.axis) add_member(object, "axis", json_of(*parameters.axis, "direction", allocator), allocator);
    add_nonempty_members(object, allocator, "up", parameters.up);
    return object;
}

}  // namespace

RelationGraph graph_from_json(const JsonValue& document, const AnnotationSet& set, const std::string& where) {
    validate(document, "graph", where);
    RelationGraph graph;
    for (const auto& entry : document["relationships"].GetArray()) {
        Relationship relationship;
        relationship.id = entry["id"].GetInt();
        relationship.type = text_in(entry, "type");
        if (const RelationType* type = find_relation_type(relationship.type)) relationship.type = type->name;
        relationship.directed = entry["isDirected"].GetBool();
        for (const auto& id : entry["annotations"].GetArray()) relationship.annotations.push_back(id.GetInt());
        relationship.is_constraint = entry["isConstraint"].GetBool();
        relationship.weight = number_or(entry, "weight", relationship.weight);
        if (const JsonValue* constraint = find_member(entry, "constraint"))
            if (!constraint->ObjectEmpty()) relationship.constraint = to_text(*constraint);
        relationship.origin = text_in(entry, "origin");
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
    JsonValue object =
        json_object(allocator, "id", relationship.id, "type", relationship.type, "isDirected", relationship.directed,
                    "annotations", relationship.annotations, "isConstraint", relationship.is_constraint);
    if (relationship.is_constraint) {
        JsonValue constraint(rapidjson::kObjectType);
        if (!relationship.constraint.empty()) constraint.CopyFrom(parse_json(relationship.constraint, "constraint"), allocator);
        add_members(object, allocator, "weight", relationship.weight, "constraint", std::move(constraint));
    }
    add_nonempty_members(object, allocator, "origin", relationship.origin, "parameters",
                         json_of(relationship.parameters, allocator));
    return object;
}

Json graph_to_json(const RelationGraph& graph, const Provenance& provenance) {
    Json document = json_document("graph");
    auto& allocator = document.GetAllocator();
    JsonValue list =
        json_list(graph.relationships, allocator, [&](const Relationship& one) { return relationship_to_json(one, allocator); });
    add_members(document, allocator, "relationships", std::move(list), "provenance", provenance.to_json(allocator));
    return document;
}

void write_graph(const Path& file, const RelationGraph& graph, const AnnotationSet& set, const Provenance& provenance) {
    check_graph(graph, set, file.filename().string());
    write_json(file, graph_to_json(graph, provenance));
}

}  // namespace ostraka
