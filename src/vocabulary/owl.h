// Converts OWL classes to SKOS concepts.
#pragma once

#include "vocabulary/rdf.h"

namespace ostraka {

/// Converts the named classes of a file without SKOS concepts to concepts. `rdfs:subClassOf` a class becomes broader. A
/// restriction (`owl:someValuesFrom` a class) becomes broaderPartitive if its property is part-of by its name or label, a
/// subproperty of such a property, or the inverse of such a property; for has-part it becomes broaderPartitive of the other
/// class. The same conversion applies within `owl:intersectionOf` of equivalent classes. Labels, comments, OBO's definitions and
/// synonyms become the corresponding SKOS properties; the ontology becomes the scheme. Deprecated classes are omitted. `notes`
/// count dropped statements. Files with SKOS concepts or without classes are returned unchanged. Time: O(n log n).
std::vector<RdfStatement> skos_of_owl(std::vector<RdfStatement> statements, std::vector<std::string>& notes);

}  // namespace ostraka
