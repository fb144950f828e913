#include "ostraka/core/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace ostraka {

Character character_at(std::string_view text, std::size_t position) {
    const std::size_t length = utf8_length(text, position);
    if (length == 0) return {0xFFFD, 1};
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[position + k]); };
    if (length == 1) return {byte(0), 1};
    char32_t code = byte(0) & (0xFFU >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) code = code << 6 | (byte(k) & 0x3FU);
    return {code, length};
}

std::u32string characters(std::string_view text) {
    std::u32string result;
    for (std::size_t position = 0; position < text.size();) {
        const Character character = character_at(text, position);
        const bool invalid = character.code == 0xFFFD && character.length == 1;
        result += invalid ? not_utf8 + static_cast<unsigned char>(text[position]) : character.code;
        position += character.length;
    }
    return result;
}

bool is_control(char32_t code) {
    return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x202A && code <= 0x202E) ||
           (code >= 0x2066 && code <= 0x2069);
}

std::string without_controls(std::string_view text, std::string_view replacement) {
    std::string result;
    result.reserve(text.size());
    for (std::size_t position = 0; position < text.size();) {
        const Character character = character_at(text, position);
        result += is_control(character.code) ? replacement : text.substr(position, character.length);
        position += character.length;
    }
    return result;
}

std::string percent_encoded(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::string_view("-._~").find(c) != std::string_view::npos;
        if (plain) result += c;
        else result += {'%', "0123456789ABCDEF"[byte >> 4], "0123456789ABCDEF"[byte & 15]};
    }
    return result;
}

std::string digits(double value) {
    std::array<char, 32> buffer{};
    const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), end};
}

std::string digits(double value, int significant) {
    std::array<char, 64> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.*g", significant, value);
    return buffer.data();
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1);
}

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

std::string_view line_at(std::string_view text, std::size_t& position) {
    const std::size_t begin = position, end = std::min(text.find('\n', position), text.size());
    position = end + 1;
    return text.substr(begin, end - begin);
}

std::vector<std::string_view> split_words(std::string_view text, std::string_view blanks) {
    std::vector<std::string_view> words;
    for (std::size_t end = 0, begin = 0; (begin = text.find_first_not_of(blanks, end)) != std::string_view::npos;) {
        end = std::min(text.find_first_of(blanks, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
    }
    return words;
}

std::optional<double> number_of(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || code != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
    return value;
}

std::optional<int> parse_int(std::string_view text) {
    text = trimmed(text);
    int value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || code != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

}  // namespace ostraka
