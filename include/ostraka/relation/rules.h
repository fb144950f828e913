// Checks the rules of a class of objects on annotations and their relationships.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/relation/graph.h"
#include "ostraka/vocabulary/class_rules.h"

namespace ostraka {

/// Checks rules with `check_class_rules` and returns the violations. Relationships are taken from the graph; without a graph,
/// containment and adjacency are computed from the mesh. `where` names the file of the rules in errors. Throws the same errors
/// as `check_class_rules`.
std::vector<RuleViolation> broken_rules(AnnotatedMeshView object, const ClassRules& rules, const Vocabulary* vocabulary,
                                        const RelationGraph* graph, const std::string& where);

}  // namespace ostraka
