// Formats texts and numbers of rules and vocabularies for messages.
#pragma once

#include "ostraka/core/text.h"
#include "ostraka/vocabulary/text_match.h"
#include "ostraka/vocabulary/vocabulary.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::detail {

/// The names in a JSON member that is a text or a list of texts.
inline std::vector<std::string> names_in(const JsonValue& object, const char* member) {
    const JsonValue* value = find_member(object, member);
    if (value != nullptr && value->IsString()) return {ostraka::text_of(*value)};
    std::vector<std::string> names;
    for (const auto& name : list_in(object, member)) names.push_back(ostraka::text_of(name));
    return names;
}

/// A number as text, with 9 significant digits.
inline std::string text_of(double value) { return digits(value, 9); }

inline std::string in_quotes(const std::string& text) { return fmt::format("'{}'", text); }  ///< the text in single quotes

/// Name of an annotation for messages: "'tag' (id 3)".
inline std::string annotation_name(const Annotation& annotation) {
    return fmt::format("{} (id {})", in_quotes(annotation.tag), annotation.id);
}

/// True if a text is one of the words, or another name of the same term of `allowed` (which may be null).
inline bool is_one_of(const std::string& value, const std::vector<std::string>& words, const AllowedAttribute* allowed) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        if (folded(word) == folded(value)) return true;
        const Term* term = allowed == nullptr ? nullptr : term_of(*allowed, word);
        return term != nullptr && term == term_of(*allowed, value);
    });
}

}  // namespace ostraka::detail
