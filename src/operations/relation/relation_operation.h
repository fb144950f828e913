// Shared by the operations on relationships: their inputs, and the table of relationships in their reports.
#pragma once

#include "operations/operations.h"

#include "ostraka/relation/graph.h"

#include <string>
#include <vector>

namespace ostraka {

/// An operation on the graph of relationships among the annotations of a mesh.
struct RelationOperation : AnnotatedMeshOperation {
    void declare_graph(Parameters& p) { p.input("graph", Kind::graph, graph, "graph (.graph.json)"); }
    void declare_output(Parameters& p) { p.output("output", Kind::graph, output, "graph to write (.graph.json)"); }
    /// Declares the table of relationships; with `checked` also the verdict on each.
    static void declare_relationships(ReportLayout& report, bool checked = false) {
        std::vector<Field> columns{integer("id", "id")};
        if (checked) columns.push_back(text("verdict", "verdict"));
        columns.insert(columns.end(), {text("type", "type"), text("origin", checked ? "" : "origin"),
                                       numbers("annotations", "annotations"), any("parameters", "measured")});
        if (checked) columns.push_back(text("text", "remark"));
        columns.insert(columns.end(), {boolean("isDirected"), boolean("isConstraint"), number("weight"), any("constraint")});
        report.table("relationships", std::move(columns));
    }

    [[nodiscard]] RelationGraph read_relations() const {
        RelationGraph relations;
        if (graph.exists()) relations.relationships = graph.on(set()).relationships;
        return relations;
    }

    /// Adds a row with the file content of the relationship, and its text for people.
    Report::Row report_result(Report& report, const Relationship& relationship) const {
        Report::Row row = report.row("relationships");
        JsonValue entry = relationship_to_json(relationship, report.allocator());
        for (auto& member : entry.GetObject()) row(member.name.GetString(), std::move(member.value));
        row.shown("id", std::to_string(relationship.id)).shown("type", type_of(relationship));
        row.shown("annotations", members_of(relationship)).shown("parameters", measured(relationship.parameters));
        return row;
    }
    void report_result(Report& report, const std::vector<Relationship>& relationships) const {
        report.empty_table("relationships");
        for (const Relationship& relationship : relationships)
            report_result(report, relationship).shown("origin", relationship.origin);
    }

    GraphInput graph;
    GraphOutput output;

    [[nodiscard]] std::string members_of(const Relationship& relationship) const {
        std::vector<std::string> members;
        for (const int id : relationship.annotations) {
            const Annotation* annotation = set().find(id);
            members.push_back(std::to_string(id) + (annotation == nullptr ? "" : " " + annotation->tag));
        }
        return joined(members, relationship.directed ? " > " : ", ");
    }

    /// The type; with the attribute for "equal attributes", and with the weight for constraints.
    static std::string type_of(const Relationship& relationship) {
        std::string text = relationship.type;
        if (!relationship.parameters.attribute.empty()) text += ": " + relationship.parameters.attribute;
        if (relationship.is_constraint) text += " (constraint, weight " + number(relationship.weight) + ")";
        return text;
    }

    static std::string measured(const RelationParameters& parameters) {
        std::string text;
        for (const auto& deviation : parameters.deviations) {
            text += (text.empty() ? "" : "; ") + deviation.quantity;
            if (deviation.value) text += " " + number(*deviation.value, 4);
            if (deviation.tolerance) text += " (at most " + number(*deviation.tolerance, 4) + ")";
            if (!deviation.unit.empty()) text += " " + deviation.unit;
        }
        return text;
    }
};

}  // namespace ostraka
