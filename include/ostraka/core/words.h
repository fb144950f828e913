// Text for messages: joined lists, plurals, printable input.
#pragma once

#include "ostraka/core/text.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// The texts joined by `between`; no separator is written before the first non-empty text.
template <class Texts>
std::string joined(const Texts& texts, std::string_view between = ", ") {
    std::string all;
    for (const auto& text : texts) {
        if (!all.empty()) all += between;
        all += text;
    }
    return all;
}
/// The word of an enumerator; `words` are in the order of the enumerators.
template <class Enumeration, std::size_t count>
const char* word_for(Enumeration value, const char* const (&words)[count]) {
    return words[static_cast<std::size_t>(value)];
}
/// The same for `say(entry)` of each entry; `say` may be a pointer to a member.
template <class Entries, class TextOf>
std::string joined(const Entries& entries, std::string_view between, const TextOf& say) {
    std::vector<std::string> texts;
    for (const auto& entry : entries) texts.push_back(std::invoke(say, entry));
    return joined(texts, between);
}
/// "07" for 7 of ten or more: all numbers from 1 to `count` get the same width.
inline std::string padded(std::size_t number, std::size_t count) {
    const std::string digits = std::to_string(number);
    return std::string(std::to_string(count).size() - digits.size(), '0') + digits;
}
/// Text from files, safe to print on a terminal: control characters are replaced by "?", and at most `maximum` columns are
/// kept.
inline std::string printable(const std::string& text, std::size_t maximum = 10000) {
    std::string clean;
    std::size_t columns = 0;
    for (std::size_t at = 0; at < text.size();) {
        const Character here = character_at(text, at);
        if (++columns > maximum) return clean + "...";
        // An invalid byte may be a control character for a terminal that does not use UTF-8.
        const bool odd = is_control(here.code) || (here.code == 0xFFFD && here.length == 1);
        clean += odd ? "?" : text.substr(at, here.length);
        at += here.length;
    }
    return clean;
}
/// "1 slice", "2 slices".
inline std::string counted(std::size_t count, std::string_view what) {
    return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace ostraka
