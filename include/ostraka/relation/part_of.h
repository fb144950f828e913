// Compares the part-whole relations of a vocabulary with the containment of the selections.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/finding.h"
#include "ostraka/relation/topology.h"
#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// The type of relationships between a whole and a part of it, [whole, part]. It does not follow from geometry alone.
inline constexpr const char* part_of_type = "part of";

/// An annotation whose concept is, by the vocabulary, a part of other concepts.
struct PartInVocabulary {
    std::size_t part;                      ///< index in the set
    std::vector<std::size_t> wholes;       ///< indices of the annotations of the nearest whole concept that has any
    std::optional<std::size_t> contained;  ///< the whole that contains the part (the smallest, if several); none if no whole
                                           ///< does
};

/// All annotations whose concept is a part, if one of its wholes is annotated. The whole object counts by its tag.
std::vector<PartInVocabulary> parts_in_vocabulary(const ContainmentOrder& order, const AnnotationSet& set,
                                                  const Vocabulary& vocabulary);

/// Reports a defect for each part that is contained in none of its wholes.
std::vector<Finding> check_parts(AnnotatedMeshView object, const Vocabulary& vocabulary);
/// A relationship for each part that is contained in one of its wholes; ids count up from `first_id`.
std::vector<Relationship> part_relationships(const ContainmentOrder& order, const AnnotationSet& set,
                                             const Vocabulary& vocabulary, int first_id);

}  // namespace ostraka
