// RapidJSON with our habits: errors that name file and place, shortest round-trip numbers, schemas.
#pragma once

#include "ostraka/core/file.h"

#include <rapidjson/document.h>

#include <array>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <string_view>

namespace ostraka {

/// RapidJSON does not check what malloc returns: this allocator throws std::bad_alloc.
class JsonMemory {
public:
    static const bool kNeedFree = true;
    void* Malloc(std::size_t size) { return checked(std::malloc(size), size); }
    void* Realloc(void* old, std::size_t /*old_size*/, std::size_t size) {
        if (size > 0) return checked(std::realloc(old, size), size);
        std::free(old);
        return nullptr;
    }
    static void Free(void* memory) { std::free(memory); }

private:
    static void* checked(void* memory, std::size_t size) {
        if (memory == nullptr && size > 0) throw std::bad_alloc();
        return memory;
    }
};

using JsonAllocator = rapidjson::MemoryPoolAllocator<JsonMemory>;
using Json = rapidjson::GenericDocument<rapidjson::UTF8<>, JsonAllocator, JsonMemory>;
using JsonValue = Json::ValueType;

/// Parses UTF-8 JSON; Error (input) gives file, line and column. Nesting deeper than 200 levels and zero bytes are refused.
Json parse_json(std::string_view text, const std::string& where);
Json read_json(const Path& file);

/// Two-space indentation, short arrays of numbers on one line, shortest digits that read back to the same double,
/// members in the order of the document, a newline at the end. Refuses NaN and infinities (Error, failure).
std::string to_text(const JsonValue& value);
void write_json(const Path& file, const JsonValue& value);
/// On one line, without blanks between the values.
std::string to_compact_text(const JsonValue& value);

/// Checks `value` against the schema `doc/schema/<name>.schema.json` (built into the library). Error (input) names
/// the JSON pointer and what was expected. Throws std::logic_error for an unknown schema name.
void validate(const JsonValue& value, const std::string& schema, const std::string& where);

/// A document that is built into the library: `data/<name>.json` of the models that were trained. Throws std::logic_error for an
/// unknown name.
Json built_in_document(const std::string& name);

/// Bytes of the UTF-8 character that begins at byte `at` of a text that is longer than that; 0 if none does.
std::size_t utf8_length(std::string_view text, std::size_t at);

/// Building blocks.
JsonValue json_string(std::string_view text, JsonAllocator& allocator);
void add_member(JsonValue& object, std::string_view name, JsonValue value, JsonAllocator& allocator);
void add_member(JsonValue& object, std::string_view name, std::string_view text, JsonAllocator& allocator);

/// Member or nullptr.
const JsonValue* find_member(const JsonValue& object, std::string_view name);

/// What stands in a member, of a number that which it must be. Where there is no such member: nothing, the other number, an empty
/// text (also where it is no text), false, an empty list (also where it is no list).
std::optional<double> number_in(const JsonValue& object, std::string_view name);
double number_or(const JsonValue& object, std::string_view name, double otherwise);
std::string text_in(const JsonValue& object, std::string_view name);
bool flag_in(const JsonValue& object, std::string_view name);
JsonValue::ConstArray list_in(const JsonValue& object, std::string_view name);

/// The text of a value that is one, and the numbers of a list of three.
std::string text_of(const JsonValue& value);
std::array<double, 3> triple_of(const JsonValue& list);

/// Throws Error (input) with `remedy` where a document says that it is of another format; it need not say one.
void check_format(const JsonValue& document, const std::string& format, const std::string& where, const std::string& remedy);

}  // namespace ostraka

// Compiled once, with the library.
extern template class rapidjson::GenericValue<rapidjson::UTF8<>, ostraka::JsonAllocator>;
extern template class rapidjson::GenericDocument<rapidjson::UTF8<>, ostraka::JsonAllocator, ostraka::JsonMemory>;
