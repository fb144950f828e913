// Import and export of vocabularies as SKOS, the W3C's format for thesauri, in Turtle and RDF/XML (doc/vocabularies.md).
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// True if the file name has an extension of SKOS files: .ttl, .turtle, .nt (Turtle), .rdf, .owl, .xml (RDF/XML).
bool is_skos(const Path& file);

/// Reads the concepts of a SKOS scheme. `scheme` is the scheme's URI; it may be empty if the file has at most one scheme.
/// Statements of kinds that Ostraka does not use are stored (ForeignStatement) if their object is a URI or a text; notes report
/// statements that are dropped. The function accesses neither the network nor other files. Throws Error (input) with file, line
/// and reason, also if the vocabulary violates the checks of read_vocabulary.
Vocabulary read_skos(const Path& file, const std::string& scheme = {});
/// Reads a vocabulary from SKOS text, with the checks of read_skos.
Vocabulary vocabulary_from_skos(const std::string& text, bool rdf_xml, const std::string& where, const std::string& scheme = {});

/// Writes a vocabulary completely, so that reading the file returns the same vocabulary. The same vocabulary gives the same
/// bytes.
void write_skos(const Path& file, const Vocabulary& vocabulary);
/// SKOS text of a vocabulary, in RDF/XML or Turtle.
std::string vocabulary_to_skos(const Vocabulary& vocabulary, bool rdf_xml, const std::string& where);

}  // namespace ostraka
