// JSON built from C++ values and lists.
#pragma once

#include "ostraka/files/json.h"

#include <concepts>
#include <type_traits>
#include <utility>

namespace ostraka {

/// Converts to a JSON value: a boolean, a number, a text, a JSON value, an optional value (null if empty), or a list of such
/// values.
template <class T>
JsonValue json_value(T&& value, JsonAllocator& allocator) {
    using Type = std::remove_cvref_t<T>;
    if constexpr (std::same_as<T, JsonValue>) return std::forward<T>(value);
    else if constexpr (std::derived_from<Type, JsonValue>) return JsonValue(value, allocator);
    else if constexpr (std::same_as<Type, bool> || std::floating_point<Type>) return JsonValue(value);
    else if constexpr (std::signed_integral<Type>) return JsonValue(static_cast<std::int64_t>(value));
    else if constexpr (std::unsigned_integral<Type>) return JsonValue(static_cast<std::uint64_t>(value));
    else if constexpr (std::convertible_to<Type, std::string_view>) return json_string(value, allocator);
    else if constexpr (requires { value.has_value(); }) return value ? json_value(*value, allocator) : JsonValue();
    else {
        JsonValue array(rapidjson::kArrayType);
        if constexpr (requires { value.size(); }) array.Reserve(static_cast<rapidjson::SizeType>(value.size()), allocator);
        for (const auto& element : value) array.PushBack(json_value(element, allocator), allocator);
        return array;
    }
}
/// JSON array of `transform(element)` for each element.
template <class Elements, class Transform>
JsonValue json_list(const Elements& elements, JsonAllocator& allocator, Transform&& transform) {
    JsonValue array(rapidjson::kArrayType);
    for (const auto& element : elements) array.PushBack(json_value(transform(element), allocator), allocator);
    return array;
}
/// The JSON array [value] with one element.
JsonValue json_list_of(JsonValue value, JsonAllocator& allocator);
/// A JSON number; whole numbers below 1e9 have no decimal point.
JsonValue json_number(double value);
/// Adds members to a JSON object; arguments are alternating names and values.
template <class Value, class... Rest>
void add_members(JsonValue& object, JsonAllocator& allocator, std::string_view name, Value&& value, Rest&&... rest) {
    add_member(object, name, json_value(std::forward<Value>(value), allocator), allocator);
    if constexpr (sizeof...(rest) > 0) add_members(object, allocator, std::forward<Rest>(rest)...);
}
/// Adds members to a JSON object like add_members, but skips the value false and empty texts, lists and optionals.
template <class Value, class... Rest>
void add_nonempty_members(JsonValue& object, JsonAllocator& allocator, std::string_view name, Value&& value, Rest&&... rest) {
    bool nonempty = false;
    if constexpr (std::derived_from<std::remove_cvref_t<Value>, JsonValue>)
        nonempty = value.IsArray() ? !value.Empty() : value.MemberCount() > 0;
    else if constexpr (requires { value.empty(); }) nonempty = !value.empty();
    else nonempty = static_cast<bool>(value);
    if (nonempty) add_members(object, allocator, name, std::forward<Value>(value));
    if constexpr (sizeof...(rest) > 0) add_nonempty_members(object, allocator, std::forward<Rest>(rest)...);
}
/// Copies the members with the given names from `from` to `object`.
void copy_members(JsonValue& object, JsonAllocator& allocator, const JsonValue& from, std::initializer_list<const char*> names);
/// The JSON object {name: value, ...} from alternating names and values.
template <class... Members>
JsonValue json_object(JsonAllocator& allocator, Members&&... members) {
    JsonValue object(rapidjson::kObjectType);
    if constexpr (sizeof...(members) > 0) add_members(object, allocator, std::forward<Members>(members)...);
    return object;
}
/// A new document {"format": "ostraka-KIND", "version": 1}, to which members can be added.
Json json_document(std::string_view kind);

}  // namespace ostraka
