// JSON built from values and lists of them.
#pragma once

#include "ostraka/core/json.h"

#include <concepts>
#include <type_traits>
#include <utility>

namespace ostraka {

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
/// [make(entry), ...] of the entries.
template <class Entries, class Make>
JsonValue json_list(const Entries& entries, JsonAllocator& allocator, const Make& make) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto& entry : entries) list.PushBack(make(entry), allocator);
    return list;
}
/// {"format": "ostraka-KIND", "version": 1}
Json json_document(std::string_view kind);

}  // namespace ostraka
