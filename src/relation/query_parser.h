// Parser of queries.
#pragma once

#include "relation/query_node.h"

namespace ostraka::detail {

/// Parses the text of a query. Throws Error (usage) with the column, the error and the remedy. Nesting is limited to 100 levels,
/// the text to 10000 bytes.
std::unique_ptr<AnnotationQuery::Node> parse_query(const std::string& text);

/// The dimension of a unit.
struct QueryUnit {
    int power = 0;      ///< power of length: 0 for angles and pure numbers, 1 for lengths, 2 for areas ...
    double factor = 1;  ///< factor from the unit to the base unit (metres and their powers, radians)
};
/// The dimension of a unit; nothing for an unknown unit.
std::optional<QueryUnit> query_unit(const std::string& unit);

}  // namespace ostraka::detail
