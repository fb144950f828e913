// The text of a query read.
#pragma once

#include "query_node.h"

namespace ostraka::detail {

/// Throws Error (usage) with the column, what is wrong and the remedy. Nested at most 100 deep, at most 10000 bytes long.
std::unique_ptr<AnnotationQuery::Node> parse_query(const std::string& text);

/// The dimension of a unit, as a power of a length, and how many of its base (metres, radians) it is; nothing where it is
/// unknown.
struct QueryUnit {
    int power = 0;
    double factor = 1;
};
std::optional<QueryUnit> query_unit(const std::string& unit);

}  // namespace ostraka::detail
