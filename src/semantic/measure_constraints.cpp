#include "ostraka/semantic/measure_constraints.h"

#include "statement.h"

#include "ostraka/geom/with_points.h"

namespace ostraka {

std::vector<ConstraintReport> measure_constraints(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                                  const std::vector<Point>& points, const RelationOptions& tolerances,
                                                  const std::string& graph_name) {
    check_options(tolerances, "constraints");
    const Mesh there = with_points(mesh, points);
    const semantic::State state(there);
    const Points rest = columns_of(mesh);
    const semantic::Shape shape{mesh, set, rest};
    std::vector<ConstraintReport> reports;
    for (const Relationship& relationship : graph.relationships) {
        if (!relationship.is_constraint) continue;
        const semantic::Statement statement = semantic::understand(shape, relationship, tolerances, graph_name);
        ConstraintReport report = semantic::report_of(relationship, statement);
        if (report.used) {
            const semantic::Measured measured = statement.measure(state);
            report.verdict = measured.verdict;
            report.deviations = measured.deviations;
            report.text = measured.text;
        }
        reports.push_back(std::move(report));
    }
    return reports;
}

}  // namespace ostraka
