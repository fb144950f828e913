// Parser of queries.
#pragma once

#include "relation/query_node.h"

namespace ostraka::detail {

/// Throws Error (usage) with the column, the error and the remedy. Nesting is limited to 100 levels, the text to 10000 bytes.
std::unique_ptr<AnnotationQuery::Node> parse_query(const std::string& text);

/// The dimension of a unit as a power of a length, and its factor to the base unit (metres, radians); nothing for an unknown
/// unit.
struct QueryUnit {
    int power = 0;
    double factor = 1;
};
std::optional<QueryUnit> query_unit(const std::string& unit);

}  // namespace ostraka::detail
