// Escaping of text that is embedded in HTML pages.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// JSON text with < > & escaped, so that the text cannot end the script element of an HTML page.
inline std::string with_markup_escaped(std::string_view json) {
    std::string text;
    text.reserve(json.size());
    // Outside strings, JSON has none of these characters.
    for (const char c : json) {
        if (c == '<') text += "\\u003C";
        else if (c == '>') text += "\\u003E";
        else if (c == '&') text += "\\u0026";
        else text += c;
    }
    return text;
}

}  // namespace ostraka
