// The rules of a class held against annotations and what stands between them.
#pragma once

#include "ostraka/relation/graph.h"
#include "ostraka/vocabulary/class_rules.h"

namespace ostraka {

/// Every rule that is broken, as `check_class_rules` finds it. Relationships are those of the graph; without one, containment and
/// adjacency are taken from the mesh. `where` names the file of the rules. Throws as `check_class_rules`.
std::vector<BrokenRule> broken_rules(const Mesh& mesh, const AnnotationSet& set, const ClassRules& rules,
                                     const Vocabulary* vocabulary, const RelationGraph* graph, const std::string& where);

}  // namespace ostraka
