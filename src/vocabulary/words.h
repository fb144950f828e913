// Texts and numbers of rules and vocabularies, as messages show them.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/text.h"

#include <string>

namespace ostraka::detail {

/// A name or a list of them in a member.
inline std::vector<std::string> names_in(const JsonValue& object, const char* member) {
    const JsonValue* value = find_member(object, member);
    if (value != nullptr && value->IsString()) return {ostraka::text_of(*value)};
    std::vector<std::string> names;
    for (const auto& name : list_in(object, member)) names.push_back(ostraka::text_of(name));
    return names;
}

inline std::string text_of(double value) { return digits(value, 9); }

inline std::string in_quotes(const std::string& text) { return "'" + text + "'"; }

}  // namespace ostraka::detail
