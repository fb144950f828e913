// RapidJSON with our habits: errors that name file and place, shortest round-trip numbers, schemas.
#pragma once

#include "ostraka/core/file.h"

#include <rapidjson/document.h>

#include <string>
#include <string_view>

namespace ostraka {

using Json = rapidjson::Document;
using JsonValue = rapidjson::Value;
using JsonAllocator = Json::AllocatorType;

/// Parses UTF-8 JSON; Error (input) gives file, line and column. Nesting deeper than 200 is refused.
Json parse_json(std::string_view text, const std::string& where);
Json read_json(const Path& file);

/// Two-space indentation, short arrays of numbers on one line, shortest digits that read back to the same double,
/// members in the order of the document, a newline at the end. Refuses NaN and infinities (Error, failure).
std::string to_text(const JsonValue& value);
void write_json(const Path& file, const JsonValue& value);

/// Checks `value` against the schema `doc/schema/<name>.schema.json` (built into the library). Error (input) names
/// the JSON pointer and what was expected. Throws std::logic_error for an unknown schema name.
void validate(const JsonValue& value, const std::string& schema, const std::string& where);

/// Bytes of the UTF-8 character that begins at byte `at` of a text that is longer than that; 0 if none does.
std::size_t utf8_length(std::string_view text, std::size_t at);

/// Building blocks.
JsonValue json_string(std::string_view text, JsonAllocator& allocator);
void add_member(JsonValue& object, std::string_view name, JsonValue value, JsonAllocator& allocator);
void add_member(JsonValue& object, std::string_view name, std::string_view text, JsonAllocator& allocator);

/// The number in a member, or another where there is none.
double number_or(const JsonValue& object, std::string_view name, double otherwise);

/// Member or nullptr.
const JsonValue* find_member(const JsonValue& object, std::string_view name);

}  // namespace ostraka
