#include "ostraka/relation/part_of.h"

#include "ostraka/core/message_text.h"

#include <algorithm>

namespace ostraka {

std::vector<PartInVocabulary> parts_in_vocabulary(const ContainmentOrder& order, const AnnotationSet& set,
                                                  const Vocabulary& vocabulary) {
    const VocabularySearch search(vocabulary);
    std::vector<std::optional<std::size_t>> concepts;
    for (const Annotation& one : set.annotations) concepts.push_back(search.concept_of(one.tag));
    std::vector<PartInVocabulary> parts;
    for (std::size_t i = 0; i < concepts.size(); ++i) {
        if (!concepts[i]) continue;
        for (const std::vector<std::size_t>& level : search.containing_concepts(*concepts[i])) {
            PartInVocabulary found{i, {}, {}};
            for (std::size_t k = 0; k < concepts.size(); ++k)
                if (k != i && concepts[k] &&
                    std::any_of(level.begin(), level.end(), [&](std::size_t whole) { return search.is_a(*concepts[k], whole); }))
                    found.wholes.push_back(k);
            if (found.wholes.empty()) continue;
            // Select the smallest whole among the containers.
            const auto& containers = order.containers[i];
            for (const std::size_t whole : found.wholes) {
                if (std::find(containers.begin(), containers.end(), whole) == containers.end()) continue;
                const auto& of_best = found.contained ? order.containers[*found.contained] : order.containers[whole];
                // A whole that lies in the one found so far is smaller.
                const auto& of_this = order.containers[whole];
                if (!found.contained || (std::find(of_this.begin(), of_this.end(), *found.contained) != of_this.end() &&
                                         std::find(of_best.begin(), of_best.end(), whole) == of_best.end()))
                    found.contained = whole;
            }
            parts.push_back(std::move(found));
            break;
        }
    }
    return parts;
}

std::vector<Finding> check_parts(AnnotatedMeshView object, const Vocabulary& vocabulary) {
    std::vector<Finding> findings;
    for (const PartInVocabulary& one : parts_in_vocabulary(topology(object).order, object.annotations, vocabulary)) {
        if (one.contained) continue;
        std::vector<std::string> names;
        for (const std::size_t whole : one.wholes) names.push_back(name_of(object.annotations.annotations[whole]));
        findings.push_back({true, "/annotations/" + std::to_string(one.part),
                            name_of(object.annotations.annotations[one.part]) +
                                " is a part by the vocabulary, but does not lie in a whole: not in " + joined(names)});
    }
    return findings;
}

std::vector<Relationship> part_relationships(const ContainmentOrder& order, const AnnotationSet& set,
                                             const Vocabulary& vocabulary, int first_id) {
    std::vector<Relationship> list;
    for (const PartInVocabulary& one : parts_in_vocabulary(order, set, vocabulary)) {
        if (!one.contained) continue;
        Relationship relationship;
        relationship.id = first_id++;
        relationship.type = part_of_type;
        relationship.directed = true;
        relationship.annotations = {set.annotations[*one.contained].id, set.annotations[one.part].id};
        relationship.origin = "extracted";
        list.push_back(std::move(relationship));
    }
    return list;
}

}  // namespace ostraka
