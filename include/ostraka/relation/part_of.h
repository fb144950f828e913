// Compares the part-whole relations of a vocabulary with the containment of annotated selections.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/finding.h"
#include "ostraka/relation/topology.h"
#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// Name of the type of relationships between a whole and a part, [whole, part]. The type does not follow from geometry alone.
inline constexpr const char* part_of_type = "part of";

/// An annotation whose concept is, according to the vocabulary, a part of other concepts.
struct PartInVocabulary {
    std::size_t part;                 ///< index of the annotation in the set
    std::vector<std::size_t> wholes;  ///< indices of the annotations of the nearest whole concept that is annotated
    /// Index of the smallest of `wholes` whose selection contains the part; empty: no whole contains it.
    std::optional<std::size_t> contained;
};

/// All annotations whose concept is a part of a concept that is annotated too. The whole object counts by its tag.
std::vector<PartInVocabulary> parts_in_vocabulary(const ContainmentOrder& order, const AnnotationSet& set,
                                                  const Vocabulary& vocabulary);

/// Reports a defect for each annotation of a part that no annotation of its wholes contains.
std::vector<Finding> check_parts(AnnotatedMeshView object, const Vocabulary& vocabulary);
/// A "part of" relationship for each annotation of a part that an annotation of its wholes contains; ids count up from
/// `first_id`.
std::vector<Relationship> part_relationships(const ContainmentOrder& order, const AnnotationSet& set,
                                             const Vocabulary& vocabulary, int first_id);

}  // namespace ostraka
