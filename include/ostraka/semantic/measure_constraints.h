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

/// The same for an object as it is. Without the shape at `rest` (the mesh with the vertices elsewhere) a constraint is judged by
/// what it says outright: ranges, points, directions, angles, one level; parts that mirror each other or touch do so within the
/// tolerances. One that keeps what the shape at rest had is unknown then, and so is one that makes no sense of the shape (an axis
/// that a part does not have); `text` says why. Throws Error (input) where `rest` has other vertices or faces.
std::vector<ConstraintReport> judge_constraints(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                                const Mesh* rest = nullptr, const RelationOptions& tolerances = {},
                                                const std::string& graph_name = "graph");

/// All relationships of a graph, in its order: constraints as `judge_constraints` has them, the others as `check_relations`.
std::vector<RelationCheck> judge_relationships(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                               const Mesh* rest = nullptr, const RelationOptions& tolerances = {},
                                               const std::string& graph_name = "graph");

}  // namespace ostraka
