// Measures how closely a given shape satisfies the constraints of a graph, without solving.
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
/// positions. Without `rest` only the explicit parameters of a constraint are judged: ranges, points, directions, angles, equal
/// levels; parts constrained to be mirrored or to touch must do so within the tolerances. The verdict is unknown for a
/// constraint that preserves a property of the shape at rest, and for a constraint that cannot be evaluated on the shape (an
/// axis that a part does not have); `text` gives the reason. Throws Error (input) if `rest` has other vertices or faces.
std::vector<ConstraintReport> judge_constraints(AnnotatedMeshView object, const RelationGraph& graph, const Mesh* rest = nullptr,
                                                const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

/// Judges all relationships of a graph, in the order of the graph: constraints as by `judge_constraints`, all other
/// relationships as by `check_relations`.
std::vector<RelationCheck> judge_relationships(AnnotatedMeshView object, const RelationGraph& graph, const Mesh* rest = nullptr,
                                               const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

}  // namespace ostraka
