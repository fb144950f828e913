// Text in other formats: cells and numbers, escaped so that nothing can become a formula, markup or a script.
#pragma once

#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace ostraka::interchange {

/// The text with U+FFFD for each byte that is not valid UTF-8.
std::string as_utf8(std::string_view text);
/// The text with control characters (core/text.h), including line breaks, replaced by blanks, for formats with one record per
/// line.
std::string one_line(std::string_view text);
/// True if `one_line` would change the text.
bool has_control(std::string_view text);

/// The numbers as text, separated by blanks; floating-point numbers are written by `digits`.
template <class Numbers>
std::string joined_numbers(const Numbers& numbers) {
    std::string text;
    for (const auto number : numbers) {
        text += text.empty() ? "" : " ";
        if constexpr (std::is_floating_point_v<std::decay_t<decltype(number)>>) text += digits(number);
        else text += std::to_string(number);
    }
    return text;
}

/// JSON text as written by `to_text`, with < > & escaped, so that the text cannot end the script element of an HTML page.
std::string json_text(const JsonValue& value);

/// The three numbers of a JSON value; nullopt unless the value is a list of three finite numbers.
std::optional<std::array<double, 3>> triple(const JsonValue* value);

}  // namespace ostraka::interchange
