// Text in and out of the formats of others: cells, numbers, and nothing that can become a formula, markup or a script.
#pragma once

#include "ostraka/core/csv.h"
#include "ostraka/core/json.h"
#include "ostraka/core/text.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka::interchange {

/// Text whose bytes are not UTF-8 has U+FFFD for each byte that does not fit.
std::string as_utf8(std::string_view text);
std::string lower(std::string_view text);
/// Control characters (core/text.h), line breaks among them, as blanks, for formats that keep a record on a line.
std::string one_line(std::string_view text);
/// True if `one_line` would change the text.
bool has_control(std::string_view text);

/// JSON as `to_text`, with < > & as escapes: it may stand inside an HTML page without ending its script.
std::string json_text(const JsonValue& value);

/// Member that is a string, or empty.
std::string text_member(const JsonValue& object, std::string_view name);
/// A list of three finite numbers, or nothing.
std::optional<std::array<double, 3>> triple(const JsonValue* value);
JsonValue triple_json(const std::array<double, 3>& values, JsonAllocator& allocator);

}  // namespace ostraka::interchange
