#include "ostraka/core/text.h"

#include "ostraka/core/json.h"

namespace ostraka {

Character character_at(std::string_view text, std::size_t at) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) return {0xFFFD, 1};
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
    if (length == 1) return {byte(0), 1};
    char32_t code = byte(0) & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) code = code << 6 | (byte(k) & 0x3FU);
    return {code, length};
}

bool is_control(char32_t code) {
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x202A && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

std::string without_controls(std::string_view text, std::string_view instead) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        const Character here = character_at(text, at);
        result += is_control(here.code) ? instead : text.substr(at, here.length);
        at += here.length;
    }
    return result;
}

}  // namespace ostraka
