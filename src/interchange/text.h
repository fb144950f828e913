// Text in and out of the formats of others: cells, numbers, and nothing that can become a formula, markup or a script.
#pragma once

#include "ostraka/core/csv.h"
#include "ostraka/core/json.h"
#include "ostraka/core/text.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace ostraka::interchange {

/// Text whose bytes are not UTF-8 has U+FFFD for each byte that does not fit.
std::string as_utf8(std::string_view text);
/// Control characters (core/text.h), line breaks among them, as blanks, for formats that keep a record on a line.
std::string one_line(std::string_view text);
/// True if `one_line` would change the text.
bool has_control(std::string_view text);

/// Numbers with blanks between them, those that are not whole as `digits` writes them.
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

/// JSON as `to_text`, with < > & as escapes: it may stand inside an HTML page without ending its script.
std::string json_text(const JsonValue& value);

/// A list of three finite numbers, or nothing.
std::optional<std::array<double, 3>> triple(const JsonValue* value);

}  // namespace ostraka::interchange
