#include "interchange/text.h"

#include "ostraka/files/markup.h"

#include <cmath>

namespace ostraka::interchange {

std::string as_utf8(std::string_view text) {
    Json scratch;
    return text_of(json_string(text, scratch.GetAllocator()));
}

bool has_control(std::string_view text) { return without_controls(text, "") != text; }

std::string one_line(std::string_view text) { return without_controls(text, " "); }

std::string json_text(const JsonValue& value) { return with_markup_escaped(to_text(value)); }

std::optional<std::array<double, 3>> triple(const JsonValue* value) {
    if (value == nullptr || !value->IsArray() || value->Size() != 3) return {};
    for (const auto& number : value->GetArray())
        if (!number.IsNumber() || !std::isfinite(number.GetDouble())) return {};
    return triple_of(*value);
}

}  // namespace ostraka::interchange
