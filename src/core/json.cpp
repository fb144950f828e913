#include "ostraka/core/json_build.h"

#include "ostraka/core/error.h"

#include <rapidjson/error/en.h>
#include <rapidjson/reader.h>
#include <rapidjson/schema.h>
#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace ostraka {

/// Made by the build from doc/schema: name and text of each schema.
const std::map<std::string, std::string_view>& schema_texts();

namespace {

using TextBuffer = rapidjson::GenericStringBuffer<rapidjson::UTF8<>, JsonMemory>;
using Schema = rapidjson::GenericSchemaDocument<JsonValue, JsonMemory>;

std::string place(std::string_view text, std::size_t offset) {
    std::size_t line = 1, column = 1;
    for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) {
        if (text[i] == '\n') {
            ++line;
            column = 1;
        } else {
            ++column;
        }
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

bool nested_too_deep(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            else if (c == '"') in_string = false;
        } else if (c == '"') in_string = true;
        else if (c == '[' || c == '{') {
            if (++depth > 200) return true;
        } else if (c == ']' || c == '}') --depth;
    }
    return false;
}

/// Where an object has two members of one name, readers differ in which they take.
void refuse_twins(const JsonValue& value, const std::string& where) {
    if (value.IsArray()) {
        for (const auto& element : value.GetArray()) {
            if (!element.IsObject() && !element.IsArray()) continue;
            refuse_twins(element, where);
        }
        return;
    }
    if (!value.IsObject()) return;
    std::vector<std::string_view> names;
    for (const auto& member : value.GetObject()) {
        names.emplace_back(member.name.GetString(), member.name.GetStringLength());
        refuse_twins(member.value, where);
    }
    std::sort(names.begin(), names.end());
    const auto twin = std::adjacent_find(names.begin(), names.end());
    if (twin != names.end())
        fail_input(where, "the member \"" + std::string(*twin) + "\" stands twice in one object", "keep one of the two");
}

/// Text that is not UTF-8 (a file name may be anything) with U+FFFD for each byte that does not fit.
std::string as_utf8(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8_length(text, i);
        if (length > 0) result.append(text.substr(i, length));
        else result += "\xEF\xBF\xBD";
        i += std::max<std::size_t>(length, 1);
    }
    return result;
}

/// Arrays of plain numbers and strings go on one line, everything else on lines of its own.
class Printer {
public:
    std::string text;
    void value(const JsonValue& v, int indent) {
        if (v.IsObject()) object(v, indent);
        else if (v.IsArray()) array(v, indent);
        else plain(v);
    }

private:
    void line(int indent) { text += '\n', text.append(2 * static_cast<std::size_t>(indent), ' '); }
    void plain(const JsonValue& v) {
        if (v.IsDouble() && !std::isfinite(v.GetDouble()))
            fail_work("JSON output", "a number is not finite", "report this as a defect");
        text += to_compact_text(v);
    }
    static bool is_short(const JsonValue& v) {
        for (const auto& element : v.GetArray())
            if (element.IsObject() || (element.IsArray() && !element.Empty())) return false;
        return true;
    }
    void array(const JsonValue& v, int indent) {
        const bool one_line = is_short(v);
        text += '[';
        bool first = true;
        for (const auto& element : v.GetArray()) {
            if (!first) text += one_line ? ", " : ",";
            first = false;
            if (!one_line) line(indent + 1);
            value(element, indent + 1);
        }
        if (!one_line && !v.Empty()) line(indent);
        text += ']';
    }
    void object(const JsonValue& v, int indent) {
        text += '{';
        bool first = true;
        for (const auto& member : v.GetObject()) {
            if (!first) text += ',';
            first = false;
            line(indent + 1);
            plain(member.name);
            text += ": ";
            value(member.value, indent + 1);
        }
        if (v.MemberCount() > 0) line(indent);
        text += '}';
    }
};

}  // namespace

Json parse_json(std::string_view text, const std::string& where) {
    if (text.size() >= 3 && text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    // RapidJSON takes a zero byte for the end of the text.
    if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
        fail_input(where + ", " + place(text, zero), "not valid JSON: a zero byte", "correct or regenerate the file");
    if (nested_too_deep(text)) fail_input(where, "the JSON is nested deeper than 200 levels", "flatten it");
    Json document;
    document.Parse<rapidjson::kParseFullPrecisionFlag | rapidjson::kParseValidateEncodingFlag>(text.data(), text.size());
    if (document.HasParseError())
        fail_input(where + ", " + place(text, document.GetErrorOffset()),
                   std::string("not valid JSON: ") + rapidjson::GetParseError_En(document.GetParseError()),
                   "correct or regenerate the file");
    refuse_twins(document, where);
    return document;
}

Json read_json(const Path& file) { return parse_json(read_file(file), file.string()); }

std::string to_text(const JsonValue& value) {
    Printer printer;
    printer.value(value, 0);
    printer.text += '\n';
    return std::move(printer.text);
}

std::string to_compact_text(const JsonValue& value) {
    TextBuffer buffer;
    rapidjson::Writer<TextBuffer, rapidjson::UTF8<>, rapidjson::UTF8<>, JsonMemory> writer(buffer);
    value.Accept(writer);
    return {buffer.GetString(), buffer.GetSize()};
}

void write_json(const Path& file, const JsonValue& value) { write_file(file, to_text(value)); }

void validate(const JsonValue& value, const std::string& schema, const std::string& where) {
    static std::mutex mutex;
    static std::map<std::string, std::unique_ptr<Schema>> compiled;
    const std::lock_guard lock(mutex);
    auto& entry = compiled[schema];
    if (!entry) {
        const auto found = schema_texts().find(schema);
        if (found == schema_texts().end()) throw std::logic_error("no schema named " + schema);
        entry = std::make_unique<Schema>(parse_json(found->second, schema + ".schema.json"));
    }
    rapidjson::GenericSchemaValidator<Schema, rapidjson::BaseReaderHandler<>, JsonMemory> validator(*entry);
    if (value.Accept(validator)) return;
    const auto text_of = [](const auto& pointer) {
        TextBuffer buffer;
        pointer.Stringify(buffer);
        return std::string(buffer.GetString(), buffer.GetSize());
    };
    const auto pointer = validator.GetInvalidDocumentPointer();
    const std::string keyword = validator.GetInvalidSchemaKeyword();
    std::string expected = keyword;
    // The rule itself, from the schema's text, says best what was expected.
    const Json schema_document = parse_json(schema_texts().at(schema), schema + ".schema.json");
    if (const JsonValue* rules = validator.GetInvalidSchemaPointer().Get(schema_document);
        rules != nullptr && rules->IsObject()) {
        if (const JsonValue* rule = find_member(*rules, keyword)) {
            std::string rule_text = to_compact_text(*rule);
            if (rule_text.size() > 200) rule_text = rule_text.substr(0, 197) + "...";
            expected += " " + rule_text;
        }
    }
    const std::string at = text_of(pointer);
    if (keyword == "additionalProperties" && pointer.GetTokenCount() > 0) {
        const auto& token = pointer.GetTokens()[pointer.GetTokenCount() - 1];
        fail_input(where, "at " + at + ": unknown member '" + std::string(token.name, token.length) + "'",
                   "is it misspelt? See doc/schema/" + schema + ".schema.json");
    }
    fail_input(where,
               "at " + (at.empty() ? std::string("the root") : at) + ": does not fit the format, which asks for " + expected,
               "see doc/schema/" + schema + ".schema.json");
}

Json built_in_document(const std::string& name) {
    const auto found = schema_texts().find(name);
    if (found == schema_texts().end()) throw std::logic_error("no document named " + name + " is built in");
    return parse_json(found->second, name + ".json");
}

std::size_t utf8_length(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
    const std::size_t length = byte(0) < 0x80                      ? 1
                               : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                               : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                               : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                                   : 0;
    if (length == 0 || at + length > text.size()) return 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(k) & 0xC0) != 0x80) return 0;
    // Overlong forms, surrogates, beyond U+10FFFF.
    if ((byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xED && byte(1) >= 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90) ||
        (byte(0) == 0xF4 && byte(1) >= 0x90))
        return 0;
    return length;
}

JsonValue json_string(std::string_view text, JsonAllocator& allocator) {
    const std::string valid = as_utf8(text);
    return JsonValue(valid.data(), static_cast<rapidjson::SizeType>(valid.size()), allocator);
}

void add_member(JsonValue& object, std::string_view name, JsonValue value, JsonAllocator& allocator) {
    object.AddMember(json_string(name, allocator), value, allocator);
}

void add_member(JsonValue& object, std::string_view name, std::string_view text, JsonAllocator& allocator) {
    add_member(object, name, json_string(text, allocator), allocator);
}

JsonValue json_list_of(JsonValue value, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    list.PushBack(value, allocator);
    return list;
}

JsonValue json_number(double value) {
    return std::abs(value) < 1e9 && value == std::floor(value) ? JsonValue(static_cast<int>(value)) : JsonValue(value);
}

void copy_members(JsonValue& object, JsonAllocator& allocator, const JsonValue& from, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const JsonValue* value = find_member(from, name)) add_members(object, allocator, name, *value);
}

Json json_document(std::string_view kind) {
    Json document(rapidjson::kObjectType);
    add_members(document, document.GetAllocator(), "format", "ostraka-" + std::string(kind), "version", 1);
    return document;
}

const JsonValue* find_member(const JsonValue& object, std::string_view name) {
    if (!object.IsObject()) return nullptr;
    const JsonValue key(rapidjson::StringRef(name.data(), static_cast<rapidjson::SizeType>(name.size())));
    const auto found = object.FindMember(key);
    return found == object.MemberEnd() ? nullptr : &found->value;
}

std::optional<double> number_in(const JsonValue& object, std::string_view name) {
    const JsonValue* value = find_member(object, name);
    return value == nullptr ? std::nullopt : std::optional(value->GetDouble());
}

double number_or(const JsonValue& object, std::string_view name, double otherwise) {
    return number_in(object, name).value_or(otherwise);
}

std::string text_in(const JsonValue& object, std::string_view name) {
    const JsonValue* value = find_member(object, name);
    return value != nullptr && value->IsString() ? text_of(*value) : std::string();
}

bool flag_in(const JsonValue& object, std::string_view name) {
    const JsonValue* value = find_member(object, name);
    return value != nullptr && value->GetBool();
}

JsonValue::ConstArray list_in(const JsonValue& object, std::string_view name) {
    static const JsonValue none(rapidjson::kArrayType);
    const JsonValue* value = find_member(object, name);
    return (value != nullptr && value->IsArray() ? *value : none).GetArray();
}

std::string text_of(const JsonValue& value) {
    if (!value.IsString()) fail_input("the document", "a value is no text", "correct or regenerate the file");
    return {value.GetString(), value.GetStringLength()};
}

std::array<double, 3> triple_of(const JsonValue& list) { return {list[0].GetDouble(), list[1].GetDouble(), list[2].GetDouble()}; }

void check_format(const JsonValue& document, const std::string& format, const std::string& where, const std::string& remedy) {
    if (const JsonValue* said = find_member(document, "format"); said != nullptr && said->IsString() && text_of(*said) != format)
        fail_input(where, "at /format: the format is '" + text_of(*said) + "'", remedy);
}

}  // namespace ostraka

template class rapidjson::GenericValue<rapidjson::UTF8<>, ostraka::JsonAllocator>;
template class rapidjson::GenericDocument<rapidjson::UTF8<>, ostraka::JsonAllocator, ostraka::JsonMemory>;
