// Reads and writes RDF through Raptor, as plain values.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

struct RdfTerm {
    enum class Kind { uri, blank, text };
    Kind kind = Kind::uri;
    std::string value;               ///< URI, name of a blank node, or text
    std::string language, datatype;  ///< of a text
    auto operator<=>(const RdfTerm&) const = default;
};

struct RdfStatement {
    RdfTerm subject;
    std::string predicate;
    RdfTerm object;
};

enum class RdfSyntax { turtle, rdf_xml };

/// The statements in the order of the file. Reads nothing but `text`: no network, no other file, no external or nested
/// entities. Throws Error (input) with file, line and reason.
std::vector<RdfStatement> parse_rdf(const std::string& text, RdfSyntax syntax, const std::string& base, const std::string& where);

/// `prefixes`: pairs of prefix and namespace. Throws Error (input) for an invalid URI and for characters that the syntax cannot
/// represent; `where` names the file to write.
std::string serialise_rdf(const std::vector<RdfStatement>& statements, RdfSyntax syntax,
                          const std::vector<std::pair<std::string, std::string>>& prefixes, const std::string& where);

}  // namespace ostraka
