// Compares the part-whole relations of a vocabulary with the containment of annotated selections.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/finding.h"
#include "ostraka/relation/topology.h"
#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// Name of the type of relationships between a whole and a part, [whole, part]. The type does not follow from geometry alone.
inline constexpr const char* part_of_type = "part of";

/// An annotation whose concept is a part of another concept of the vocabulary.
struct PartInVocabulary {
    std::size_t part;  ///< index of the annotation in the set
    /// Indices of the annotations of the whole concept; if this concept has no annotations, of the next larger whole.
    std::vector<std::size_t> wholes;
    /// Index of the smallest of `wholes` whose selection contains the part; empty: no whole contains it.
    std::optional<std::size_t> contained;
};

/// All annotations whose concept is a part of a concept that is annotated too. The tag of the annotation of the whole object is
/// included.
std::vector<PartInVocabulary> parts_in_vocabulary(const ContainmentOrder& order, const AnnotationSet& set,
                                                  const Vocabulary& vocabulary);

/// Reports a defect for each annotation that is a part according to the vocabulary, but is not contained in any annotation of
/// its wholes.
std::vector<Finding> check_parts(AnnotatedMeshView object, const Vocabulary& vocabulary);
/// Makes a "part of" relationship for each annotation that is a part according to the vocabulary and is contained in an
/// annotation of its wholes; ids count up from `first_id`.
std::vector<Relationship> part_relationships(const ContainmentOrder& order, const AnnotationSet& set,
                                             const Vocabulary& vocabulary, int first_id);

}  // namespace ostraka
