// The fields by which sets, annotations and attributes are compared.
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka::interchange {

/// True if all fields of two attributes are equal.
bool same(const Attribute& a, const Attribute& b);
/// True if two annotations have the same type and select the same elements and curves.
bool same_geometry(const Annotation& a, const Annotation& b);
/// True if all fields of two annotations are equal.
bool same(const Annotation& a, const Annotation& b);

/// The value of a field as complete text on one line.
std::string as_text(const std::string& text);
std::string as_text(const std::array<int, 3>& colour);  ///< three numbers separated by blanks
std::string as_text(const std::optional<std::array<double, 3>>& direction);
std::string as_text(const std::vector<Information>& entries);
std::string as_text(const Attribute& attribute);
std::string geometry_as_text(const Annotation& annotation);
std::string as_text(const Annotation& annotation);
/// The ids of the entries, in order.
template <class Entries>
std::vector<int> ids_of(const Entries& entries) {
    std::vector<int> ids;
    for (const auto& entry : entries) ids.push_back(entry.id);
    return ids;
}
std::string as_text(const std::vector<int>& ids);

}  // namespace ostraka::interchange
