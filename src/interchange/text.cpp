#include "text.h"

#include "ostraka/core/markup.h"

#include <cmath>

namespace ostraka::interchange {

std::string as_utf8(std::string_view text) {
    Json scratch;
    const JsonValue value = json_string(text, scratch.GetAllocator());
    return {value.GetString(), value.GetStringLength()};
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

bool has_control(std::string_view text) { return without_controls(text, "") != text; }

std::string one_line(std::string_view text) { return without_controls(text, " "); }

std::string json_text(const JsonValue& value) { return with_markup_escaped(to_text(value)); }

std::string text_member(const JsonValue& object, std::string_view name) {
    const JsonValue* value = find_member(object, name);
    return value != nullptr && value->IsString() ? std::string(value->GetString(), value->GetStringLength()) : std::string();
}

std::optional<std::array<double, 3>> triple(const JsonValue* value) {
    if (value == nullptr || !value->IsArray() || value->Size() != 3) return {};
    std::array<double, 3> result{};
    for (rapidjson::SizeType i = 0; i < 3; ++i) {
        if (!(*value)[i].IsNumber() || !std::isfinite((*value)[i].GetDouble())) return {};
        result[i] = (*value)[i].GetDouble();
    }
    return result;
}

JsonValue triple_json(const std::array<double, 3>& values, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const double value : values) list.PushBack(value, allocator);
    return list;
}

}  // namespace ostraka::interchange
