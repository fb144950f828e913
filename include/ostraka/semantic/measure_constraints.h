// How well the constraints of a graph hold on a shape as it is; nothing is solved.
#pragma once

#include "ostraka/semantic/deform.h"

namespace ostraka {

/// One report for each relationship that is a constraint, in the graph's order: `verdict` and `deviations` are those of `points`
/// (one for each vertex of the mesh, which is the shape at rest); what belongs to a solution is empty. A constraint of weight
/// zero is left out. Throws Error (usage) unless there is a point for each vertex; (input) as `deform` for constraints that
/// cannot be made sense of.
std::vector<ConstraintReport> measure_constraints(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                                  const std::vector<Point>& points, const RelationOptions& tolerances = {},
                                                  const std::string& graph_name = "graph");

}  // namespace ostraka
