#include "ostraka/semantic/measure_constraints.h"

#include "semantic/statement.h"

#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/geom/with_points.h"

#include <algorithm>
#include <array>

namespace ostraka {

namespace {

using semantic::Shape;
using semantic::State;

/// Measures a constraint on a state of a shape. Throws as `understand` does.
ConstraintReport measured(const Shape& shape, const State& state, const Relationship& relationship,
                          const RelationOptions& tolerances, const std::string& graph_name) {
    const semantic::Statement statement = semantic::understand(shape, relationship, tolerances, graph_name);
    ConstraintReport report = semantic::report_of(relationship, statement);
    if (!report.used) return report;
    if (shape.alone && !statement.keeps.empty()) {
        report.text = "cannot be judged on one object: it keeps " + statement.keeps + " as at rest; give --rest";
        return report;
    }
    const semantic::Measured found = statement.measure(state);
    report.verdict = found.verdict;
    report.deviations = found.deviations;
    report.text = found.text;
    return report;
}

/// The corners of all faces, independent of the order of the faces.
std::vector<std::array<Index, 3>> sorted_faces(const Mesh& mesh) {
    std::vector<std::array<Index, 3>> faces;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        std::array<Index, 3> ids{a, b, c};
        std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
        faces.push_back(ids);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

void check_rest(const Mesh& mesh, const Mesh& rest) {
    const std::string remedy = "give the same mesh, its vertices in the same order, in the shape that it had";
    if (rest.number_of_vertices() != mesh.number_of_vertices())
        fail_input("the shape at rest",
                   "has " + std::to_string(rest.number_of_vertices()) + " vertices, the mesh " +
                       std::to_string(mesh.number_of_vertices()),
                   remedy);
    if (sorted_faces(rest) != sorted_faces(mesh)) fail_input("the shape at rest", "has other faces than the mesh", remedy);
}

}  // namespace

std::vector<ConstraintReport> measure_constraints(AnnotatedMeshView object, const RelationGraph& graph,
                                                  const std::vector<Point>& points, const RelationOptions& tolerances,
                                                  const std::string& graph_name) {
    check_options(tolerances, "constraints");
    const Mesh there = with_points(object.mesh, points);
    const State state(there);
    const Points rest = columns_of(object.mesh);
    std::vector<ConstraintReport> reports;
    for (const Relationship& relationship : graph.relationships)
        if (relationship.is_constraint) reports.push_back(measured({object, rest}, state, relationship, tolerances, graph_name));
    return reports;
}

std::vector<ConstraintReport> judge_constraints(AnnotatedMeshView object, const RelationGraph& graph, const Mesh* rest,
                                                const RelationOptions& tolerances, const std::string& graph_name) {
    check_options(tolerances, "constraints");
    if (rest != nullptr) check_rest(object.mesh, *rest);
    // Only the points of the shape at rest are used; the faces are those of the mesh.
    const Mesh then = rest == nullptr ? object.mesh : with_points(object.mesh, points_of(*rest));
    const State state(object.mesh);
    const Points points = columns_of(then);
    std::vector<ConstraintReport> reports;
    for (const Relationship& relationship : graph.relationships) {
        if (!relationship.is_constraint) continue;
        try {
            reports.push_back(
                measured({{then, object.annotations}, points, rest == nullptr}, state, relationship, tolerances, graph_name));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            ConstraintReport& report = reports.emplace_back(semantic::report_of(relationship, {}));
            report.text = "cannot be judged: " + error.problem() + (error.remedy().empty() ? "" : " (" + error.remedy() + ")");
        }
    }
    return reports;
}

std::vector<RelationCheck> judge_relationships(AnnotatedMeshView object, const RelationGraph& graph, const Mesh* rest,
                                               const RelationOptions& tolerances, const std::string& graph_name) {
    const std::vector<ConstraintReport> constraints = judge_constraints(object, graph, rest, tolerances, graph_name);
    // A constraint that was ignored may still be measured as a relation.
    RelationGraph relations;
    relations.relationships = graph.relationships;
    std::size_t place = 0;
    for (Relationship& one : relations.relationships) {
        if (!one.is_constraint || constraints.at(place++).used) continue;
        one.is_constraint = false;
        one.constraint.clear();
    }
    std::vector<RelationCheck> checks = check_relations(object, relations, tolerances);
    std::size_t next = 0;
    for (std::size_t i = 0; i < checks.size(); ++i) {
        if (!graph.relationships[i].is_constraint) continue;
        const ConstraintReport& constraint = constraints.at(next++);
        if (!constraint.used && checks[i].verdict != Verdict::unknown) continue;
        checks[i].verdict = constraint.verdict;
        checks[i].text = constraint.text;
        if (constraint.verdict == Verdict::fails && constraint.text.empty())
            checks[i].text =
                "out of tolerance: " + joined(constraint.deviations, ", ", [](const Deviation& d) { return d.quantity; });
        if (!constraint.deviations.empty()) checks[i].parameters.deviations = constraint.deviations;
    }
    return checks;
}

}  // namespace ostraka
