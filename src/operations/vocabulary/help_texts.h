// Help texts shared by the operations on vocabularies.
#pragma once

namespace ostraka {

inline constexpr const char* vocabulary_file = "vocabulary (.vocabulary.json, .ttl, .rdf)";
inline constexpr const char* scheme_help = "URI of the concept scheme, if a SKOS file has several";

}  // namespace ostraka
