// Texts inside HTML pages.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// JSON with escapes for < > &: it may stand inside an HTML page without ending its script.
inline std::string with_markup_escaped(std::string_view json) {
    std::string text;
    text.reserve(json.size());
    // Outside of strings JSON has none of these characters.
    for (const char c : json) {
        if (c == '<') text += "\\u003C";
        else if (c == '>') text += "\\u003E";
        else if (c == '&') text += "\\u0026";
        else text += c;
    }
    return text;
}

}  // namespace ostraka
