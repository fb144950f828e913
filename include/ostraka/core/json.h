// RapidJSON with our habits: errors that name file and place, shortest round-trip numbers, schemas.
#pragma once

#include "ostraka/core/file.h"

#include <rapidjson/document.h>

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>

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

/// Of a boolean, number, text or JSON value, an optional of these (null where there is none), or a list of any.
template <class T>
JsonValue json_value(T&& value, JsonAllocator& allocator) {
    using Type = std::remove_cvref_t<T>;
    if constexpr (std::same_as<T, JsonValue>) return std::move(value);
    else if constexpr (std::derived_from<Type, JsonValue>) return JsonValue(value, allocator);
    else if constexpr (std::same_as<Type, bool> || std::floating_point<Type>) return JsonValue(value);
    else if constexpr (std::signed_integral<Type>) return JsonValue(static_cast<std::int64_t>(value));
    else if constexpr (std::unsigned_integral<Type>) return JsonValue(static_cast<std::uint64_t>(value));
    else if constexpr (std::convertible_to<Type, std::string_view>) return json_string(value, allocator);
    else if constexpr (requires { value.has_value(); }) return value ? json_value(*value, allocator) : JsonValue();
    else {
        JsonValue list(rapidjson::kArrayType);
        for (const auto& one : value) list.PushBack(json_value(one, allocator), allocator);
        return list;
    }
}
/// Adds names and values in turn.
template <class Value, class... Rest>
void add_members(JsonValue& object, JsonAllocator& allocator, std::string_view name, Value&& value, Rest&&... rest) {
    add_member(object, name, json_value(std::forward<Value>(value), allocator), allocator);
    if constexpr (sizeof...(rest) > 0) add_members(object, allocator, std::forward<Rest>(rest)...);
}
/// {name: value, ...} of names and values in turn.
template <class... Members>
JsonValue json_object(JsonAllocator& allocator, Members&&... members) {
    JsonValue object(rapidjson::kObjectType);
    if constexpr (sizeof...(members) > 0) add_members(object, allocator, std::forward<Members>(members)...);
    return object;
}
/// {"format": "ostraka-KIND", "version": 1}
Json json_document(std::string_view kind);

/// The number in a member, or another where there is none.
double number_or(const JsonValue& object, std::string_view name, double otherwise);

/// Member or nullptr.
const JsonValue* find_member(const JsonValue& object, std::string_view name);

}  // namespace ostraka
