// URIs used in SKOS files.
#pragma once

#include "ostraka/core/text.h"
#include "ostraka/files/file.h"

#include <string>

namespace ostraka::skos {

inline const std::string rdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
inline const std::string rdfs = "http://www.w3.org/2000/01/rdf-schema#";
inline const std::string xsd = "http://www.w3.org/2001/XMLSchema#";
inline const std::string core = "http://www.w3.org/2004/02/skos/core#";
inline const std::string xl = "http://www.w3.org/2008/05/skos-xl#";
/// Namespace of ISO 25964, for part-whole relations (broaderPartitive, narrowerPartitive).
inline const std::string thesaurus = "http://purl.org/iso25964/skos-thes#";
inline const std::string dcterms = "http://purl.org/dc/terms/";
/// Ostraka's own namespace, for attributes that a concept may have, and rules.
inline const std::string ostraka_ns = "urn:ostraka:ns#";
/// URI of a vocabulary that states no URI.
inline const std::string default_scheme = "urn:ostraka:vocabulary";

/// Whether the extension of the file name is one of RDF/XML; otherwise the file is Turtle.
inline bool is_rdf_xml(const Path& file) {
    const std::string ending = extension(file);
    return ending == ".rdf" || ending == ".owl" || ending == ".xml";
}

/// Prefix of the URIs of concepts; the id follows.
inline std::string namespace_of(const std::string& scheme) {
    const std::string uri = scheme.empty() ? default_scheme : scheme;
    return uri.ends_with('#') || uri.ends_with('/') ? uri : uri + "#";
}

/// The text with percent-encoded characters decoded.
inline std::string percent_decoded(const std::string& text) {
    const auto digit = [](char c) {
        return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
    };
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
            result += static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2]));
            i += 2;
        } else {
            result += text[i];
        }
    }
    return result;
}

}  // namespace ostraka::skos
