// Reads and writes RDF through the library Raptor, as plain values.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// A subject or object of an RDF statement.
struct RdfTerm {
    enum class Kind { uri, blank, text };
    Kind kind = Kind::uri;
    std::string value;               ///< URI, name of a blank node, or text
    std::string language, datatype;  ///< language or data type of a text; empty: none
    auto operator<=>(const RdfTerm&) const = default;
};

struct RdfStatement {
    RdfTerm subject;
    std::string predicate;  ///< URI of the predicate
    RdfTerm object;
};

enum class RdfSyntax { turtle, rdf_xml };

/// Parses the statements of an RDF text, in the order of the text. Reads nothing but `text`: no network, no other file, no
/// external or nested entities. `base`: base URI; `where` names the file in errors. Throws Error (input) with file, line and
/// reason.
std::vector<RdfStatement> parse_rdf(const std::string& text, RdfSyntax syntax, const std::string& base, const std::string& where);

/// Writes statements as RDF text. `prefixes`: pairs of prefix and namespace. Throws Error (input) for an invalid URI and for
/// characters that the syntax cannot represent; `where` names the file to write.
std::string serialise_rdf(const std::vector<RdfStatement>& statements, RdfSyntax syntax,
                          const std::vector<std::pair<std::string, std::string>>& prefixes, const std::string& where);

}  // namespace ostraka
