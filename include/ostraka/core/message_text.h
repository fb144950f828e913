// Text for messages: joined lists, plurals, printable input.
#pragma once

#include "ostraka/core/text.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// The texts joined by `separator`; no separator is written before the first non-empty text.
template <class Texts>
std::string joined(const Texts& texts, std::string_view separator = ", ") {
    std::string result;
    for (const auto& text : texts) {
        if (!result.empty()) result += separator;
        result += text;
    }
    return result;
}
/// The name of an enumerator; `words` are the names in the order of the enumerators.
template <class Enumeration, std::size_t count>
const char* enum_name(Enumeration value, const char* const (&words)[count]) {
    return words[static_cast<std::size_t>(value)];
}
/// Joins the texts `text_of(entry)` of all entries by `separator`; `text_of` may be a pointer to a member.
template <class Entries, class TextOf>
std::string joined(const Entries& entries, std::string_view separator, const TextOf& text_of) {
    std::vector<std::string> texts;
    texts.reserve(std::size(entries));
    for (const auto& entry : entries) texts.push_back(std::invoke(text_of, entry));
    return joined(texts, separator);
}
/// The number with leading zeros, so that all numbers from 1 to `count` have the same width: "07" for 7 of 10.
inline std::string padded(std::size_t number, std::size_t count) {
    const std::string digits = std::to_string(number);
    return std::string(std::to_string(count).size() - digits.size(), '0') + digits;
}
/// Makes a text from a file safe to print on a terminal: control characters are replaced by "?", and at most `maximum` characters
/// are kept.
inline std::string printable(const std::string& text, std::size_t maximum = 10000) {
    std::string clean;
    std::size_t columns = 0;
    for (std::size_t position = 0; position < text.size();) {
        const Character character = character_at(text, position);
        if (++columns > maximum) return clean + "...";
        // An invalid byte may be a control character for a terminal that does not use UTF-8.
        const bool unsafe = is_control(character.code) || (character.code == 0xFFFD && character.length == 1);
        clean += unsafe ? "?" : text.substr(position, character.length);
        position += character.length;
    }
    return clean;
}
/// A count with its noun: "1 slice", "2 slices".
inline std::string counted(std::size_t count, std::string_view noun) {
    return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace ostraka
