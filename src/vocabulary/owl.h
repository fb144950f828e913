// Classes of OWL as the concepts of SKOS.
#pragma once

#include "rdf.h"

namespace ostraka {

/// Of a file without SKOS concepts: its named classes as concepts. `rdfs:subClassOf` a class becomes broader; a restriction
/// (`owl:someValuesFrom` a class) on a property that is part-of by its name or label, or below such a one, or the inverse of one,
/// becomes broaderPartitive or, for has-part, that of the other class; the same within `owl:intersectionOf` of equivalent
/// classes. Labels, comments, OBO's definitions and synonyms become those of SKOS; the ontology becomes the scheme. Deprecated
/// classes are left out. Notes count what is not kept. Files with SKOS concepts or without classes stay as they are. O(n log n).
std::vector<RdfStatement> skos_of_owl(std::vector<RdfStatement> statements, std::vector<std::string>& notes);

}  // namespace ostraka
