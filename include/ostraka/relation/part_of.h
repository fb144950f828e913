// Wholes and parts as a vocabulary has them, held against the selections.
#pragma once

#include "ostraka/core/finding.h"
#include "ostraka/relation/topology.h"
#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// The type of relationships between an annotation and a part of it, [whole, part]. Geometry alone cannot tell it.
inline constexpr const char* part_of_type = "part of";

/// An annotation whose concept is a part of others'.
struct PartInVocabulary {
    std::size_t part;                      ///< place in the set
    std::vector<std::size_t> wholes;       ///< of the nearest whole concept that has annotations: these
    std::optional<std::size_t> contained;  ///< the one that contains it, of several the smallest; none where none does
};

/// Of every annotation with a concept that is a part, where a whole is annotated. The whole object counts by its tag.
std::vector<PartInVocabulary> parts_in_vocabulary(const ContainmentOrder& order, const AnnotationSet& set,
                                                  const Vocabulary& vocabulary);

/// A defect for each part that lies in none of its wholes.
std::vector<Finding> check_parts(const Mesh& mesh, const AnnotationSet& set, const Vocabulary& vocabulary);
/// A relationship for each part that lies in one of its wholes; ids count up from `first_id`.
std::vector<Relationship> part_relationships(const ContainmentOrder& order, const AnnotationSet& set,
                                             const Vocabulary& vocabulary, int first_id);

}  // namespace ostraka
