// Lists and counts in words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ostraka {

/// The texts, one after the other, with something between them; nothing stands before the first that is not empty.
template <class Texts>
std::string joined(const Texts& texts, std::string_view between = ", ") {
    std::string all;
    for (const auto& text : texts) {
        if (!all.empty()) all += between;
        all += text;
    }
    return all;
}
/// The word of an enumerator, of words in the order of the enumerators.
template <class Enumeration, std::size_t count>
const char* word_for(Enumeration value, const char* const (&words)[count]) {
    return words[static_cast<std::size_t>(value)];
}
/// "1 slice", "2 slices".
inline std::string counted(std::size_t count, std::string_view what) {
    return std::to_string(count) + " " + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace ostraka
