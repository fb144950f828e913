// JSON with RapidJSON: errors that name file and position, shortest round-trip numbers, schemas.
#pragma once

#include "ostraka/files/file.h"

#include <rapidjson/document.h>

#include <array>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <string_view>

namespace ostraka {

/// Base allocator for RapidJSON that throws std::bad_alloc, because RapidJSON does not check the result of malloc.
class JsonMemory {
public:
    // NOLINTBEGIN(readability-identifier-naming): names that RapidJSON requires
    static const bool kNeedFree = true;  ///< required by RapidJSON: memory must be freed with Free
    void* Malloc(std::size_t size) { return checked(std::malloc(size), size); }
    void* Realloc(void* old, std::size_t /*old_size*/, std::size_t size) {
        if (size > 0) return checked(std::realloc(old, size), size);
        std::free(old);
        return nullptr;
    }
    static void Free(void* memory) { std::free(memory); }
    // NOLINTEND(readability-identifier-naming)

private:
    static void* checked(void* memory, std::size_t size) {
        if (memory == nullptr && size > 0) throw std::bad_alloc();
        return memory;
    }
};

using JsonAllocator = rapidjson::MemoryPoolAllocator<JsonMemory>;
using Json = rapidjson::GenericDocument<rapidjson::UTF8<>, JsonAllocator, JsonMemory>;
using JsonValue = Json::ValueType;

/// Parses UTF-8 JSON. Throws Error (input) with file, line and column. Refuses nesting deeper than 200 levels and zero bytes.
Json parse_json(std::string_view text, const std::string& where);
Json read_json(const Path& file);

/// JSON text with two-space indentation, short arrays of numbers on one line, the shortest digits that read back to the same
/// double, members in the order of the document, and a newline at the end. Throws Error (failure) for NaN and infinities.
std::string to_text(const JsonValue& value);
void write_json(const Path& file, const JsonValue& value);
/// JSON text on one line, without blanks between the values.
std::string to_compact_text(const JsonValue& value);

/// Validates `value` against the schema `doc/schema/<name>.schema.json` (built into the library). Throws Error (input) with the
/// JSON pointer and the violated rule, std::logic_error for an unknown schema name.
void validate(const JsonValue& value, const std::string& schema, const std::string& where);

/// A document that is built into the library: the trained model `data/<name>.json`. Throws std::logic_error for an unknown name.
Json built_in_document(const std::string& name);

/// Length in bytes of the UTF-8 character at byte `position`, which must be below the length of the text; 0 if no valid character
/// begins there.
std::size_t utf8_length(std::string_view text, std::size_t position);

JsonValue json_string(std::string_view text, JsonAllocator& allocator);
void add_member(JsonValue& object, std::string_view name, JsonValue value, JsonAllocator& allocator);
void add_member(JsonValue& object, std::string_view name, std::string_view text, JsonAllocator& allocator);

/// The member of this name; null if the object has no such member.
const JsonValue* find_member(const JsonValue& object, std::string_view name);

/// The number in a member; nullopt if there is no such member. The member must be a number.
std::optional<double> number_in(const JsonValue& object, std::string_view name);
/// The number in a member; `fallback` if there is no such member. The member must be a number.
double number_or(const JsonValue& object, std::string_view name, double fallback);
/// The text in a member; empty if there is no such member or the member is not a string.
std::string text_in(const JsonValue& object, std::string_view name);
/// True if the member exists and is true.
bool flag_in(const JsonValue& object, std::string_view name);
/// The list in a member; empty if there is no such member or the member is not an array.
JsonValue::ConstArray list_in(const JsonValue& object, std::string_view name);

/// The text of a JSON string.
std::string text_of(const JsonValue& value);
/// The numbers of a JSON array of three numbers.
std::array<double, 3> triple_of(const JsonValue& values);

/// Throws Error (input) with `remedy` if the document has a member "format" with a value other than `format`. A document
/// without a format is accepted.
void check_format(const JsonValue& document, const std::string& format, const std::string& where, const std::string& remedy);

}  // namespace ostraka

// Compiled once, with the library.
extern template class rapidjson::GenericValue<rapidjson::UTF8<>, ostraka::JsonAllocator>;
extern template class rapidjson::GenericDocument<rapidjson::UTF8<>, ostraka::JsonAllocator, ostraka::JsonMemory>;
