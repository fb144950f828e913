// Measures how well the constraints of a graph hold on a given shape, without solving.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/semantic/deform.h"

namespace ostraka {

/// One report for each relationship that is a constraint, in the order of the graph. `verdict` and `deviations` are measured on
/// `points` (one for each vertex of `mesh`, which is the shape at rest); members that describe a solution are empty. A constraint
/// of weight zero is ignored. Throws Error (usage) unless there is one point per vertex; Error (input) as `deform` for invalid
/// constraints.
std::vector<ConstraintReport> measure_constraints(AnnotatedMeshView object, const RelationGraph& graph,
                                                  const std::vector<Point>& points, const RelationOptions& tolerances = {},
                                                  const std::string& graph_name = "graph");

/// Judges the constraints of a graph on the mesh itself; one report for each constraint. `rest`: the same mesh with other vertex
/// positions. Without `rest` a constraint is judged by its explicit parameters: ranges, points, directions, angles, one level;
/// mirrored or touching parts must be mirrored or touch within the tolerances. The verdict is unknown for a constraint that
/// preserves a property of the shape at rest, and for a constraint that cannot be evaluated on the shape (an axis that a part
/// does not have); `text` gives the reason. Throws Error (input) if `rest` has other vertices or faces.
std::vector<ConstraintReport> judge_constraints(AnnotatedMeshView object, const RelationGraph& graph, const Mesh* rest = nullptr,
                                                const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

/// Judges all relationships of a graph, in the order of the graph: constraints as by `judge_constraints`, the others as by
/// `check_relations`.
std::vector<RelationCheck> judge_relationships(AnnotatedMeshView object, const RelationGraph& graph, const Mesh* rest = nullptr,
                                               const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

}  // namespace ostraka
