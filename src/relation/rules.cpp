#include "ostraka/relation/rules.h"

#include "ostraka/relation/topology.h"

namespace ostraka {

std::vector<RuleViolation> broken_rules(AnnotatedMeshView object, const ClassRules& rules, const Vocabulary* vocabulary,
                                        const RelationGraph* graph, const std::string& where) {
    std::vector<Relationship> relationships;
    if (graph != nullptr) relationships = graph->relationships;
    else if (rules.uses_relations()) relationships = relationships_of(topology(object), object.annotations, 0);
    std::vector<RelationFact> facts;
    for (const Relationship& one : relationships) facts.push_back({one.type, one.directed, one.annotations});
    return check_class_rules(object.annotations, rules, vocabulary, facts, where);
}

}  // namespace ostraka
