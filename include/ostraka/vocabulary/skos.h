// Vocabularies as SKOS, the W3C's format for thesauri, in Turtle and RDF/XML (doc/vocabularies.md).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// Is the file SKOS by its ending: .ttl, .turtle, .nt (Turtle), .rdf, .owl, .xml (RDF/XML)?
bool is_skos(const Path& file);

/// Reads the concepts of a scheme; `scheme` is its URI, and may be empty where the file has one at most. Statements about
/// concepts that we do not use are kept where they name a URI or a text; notes say what was not. Neither the network nor other
/// files are touched. Throws Error (input) with file, line and reason; what read_vocabulary refuses is refused.
Vocabulary read_skos(const Path& file, const std::string& scheme = {});
Vocabulary vocabulary_from_skos(const std::string& text, bool rdf_xml, const std::string& where, const std::string& scheme = {});

/// Writes everything a vocabulary holds: reading it again gives the same vocabulary. The same vocabulary gives the same bytes.
void write_skos(const Path& file, const Vocabulary& vocabulary);
std::string vocabulary_to_skos(const Vocabulary& vocabulary, bool rdf_xml, const std::string& where);

}  // namespace ostraka
