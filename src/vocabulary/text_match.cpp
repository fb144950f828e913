#include "ostraka/vocabulary/text_match.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>
#include <rapidjson/encodings.h>
#include <rapidjson/stringbuffer.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

std::string encoded(const std::u32string& points) {
    rapidjson::StringBuffer text;
    for (const char32_t p : points) {
        if (p >= not_utf8) text.Put(static_cast<char>(p - not_utf8));
        else rapidjson::UTF8<>::Encode(text, p);
    }
    return {text.GetString(), text.GetSize()};
}

char32_t lower(char32_t c) {
    const auto within = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
    if (within(U'A', U'Z') || (within(0xC0, 0xDE) && c != 0xD7)) return c + 32;  // ASCII, Latin-1
    if (within(0x100, 0x137) && c != 0x130 && c != 0x131) return c | 1U;         // Latin Extended-A: pairs, upper case is even
    if (within(0x139, 0x148)) return c % 2 == 1 ? c + 1 : c;                     // upper case is odd
    if (within(0x14A, 0x177)) return c | 1U;
    if (c == 0x178) return 0xFF;
    if (within(0x179, 0x17E)) return c % 2 == 1 ? c + 1 : c;
    if (within(0x391, 0x3AB) && c != 0x3A2) return c + 32;  // Greek
    if (c == 0x386) return 0x3AC;
    if (within(0x388, 0x38A)) return c + 37;
    if (c == 0x38C) return 0x3CC;
    if (c == 0x38E || c == 0x38F) return c + 63;
    if (c == 0x3C2) return 0x3C3;             // final sigma
    if (within(0x410, 0x42F)) return c + 32;  // Cyrillic
    if (within(0x400, 0x40F)) return c + 80;
    return c;
}

bool blank(char32_t c) { return c == ' ' || (c >= 9 && c <= 13) || c == 0xA0 || (c >= 0x2000 && c <= 0x200A) || c == 0x202F; }

struct Unit {
    double factor;
    int length;  ///< power of length; 0 for an angle
};

std::optional<Unit> unit_of(std::string text) {
    // In micrometres, so that all factors are whole numbers and their ratios are rounded once.
    static const std::map<std::string, double> lengths{{"um", 1},  {"\xC2\xB5m", 1}, {"mm", 1e3},   {"cm", 1e4},   {"dm", 1e5},
                                                       {"m", 1e6}, {"km", 1e9},      {"in", 25400}, {"ft", 304800}};
    if (text == "rad") return Unit{1, 0};
    if (text == "deg" || text == "\xC2\xB0") return Unit{degree, 0};
    const bool reciprocal = text.starts_with("1/");
    if (reciprocal) text.erase(0, 2);
    int power = 1;
    if (text.ends_with("^2")) power = 2;
    if (text.ends_with("^3")) power = 3;
    if (power > 1) text.erase(text.size() - 2);
    const auto unit = lengths.find(text);
    if (unit == lengths.end()) return std::nullopt;
    if (reciprocal) power = -power;
    return Unit{std::pow(unit->second, power), power};
}

}  // namespace

std::string folded(std::string_view text) {
    std::u32string result;
    for (const char32_t c : characters(text)) {
        if (!blank(c)) result += lower(c);
        else if (!result.empty() && result.back() != U' ') result += U' ';
    }
    if (!result.empty() && result.back() == U' ') result.pop_back();
    return encoded(result);
}

std::vector<std::string> near_misses(const std::string& text, const std::vector<std::string>& candidates, std::size_t maximum) {
    if (text.size() > 200) return {};
    const std::string folded_text = folded(text);
    std::vector<std::pair<std::size_t, std::size_t>> matches;  // distance, candidate index
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (candidates[i].size() > 400) continue;
        const std::string candidate = folded(candidates[i]);
        const std::size_t limit = std::max<std::size_t>(1, (std::max(folded_text.size(), candidate.size()) + 1) / 3);
        const std::size_t distance = edit_distance(folded_text, candidate, limit);
        if (distance <= limit && distance < std::max(folded_text.size(), candidate.size())) matches.emplace_back(distance, i);
    }
    std::sort(matches.begin(), matches.end());
    std::vector<std::string> result;
    for (const auto& [distance, i] : matches) {
        if (result.size() == maximum) break;
        if (std::find(result.begin(), result.end(), candidates[i]) == result.end()) result.push_back(candidates[i]);
    }
    return result;
}

std::string did_you_mean(const std::vector<std::string>& suggestions) {
    return suggestions.empty() ? "" : fmt::format(": did you mean {}?", alternatives(suggestions));
}

std::string alternatives(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += fmt::format("{}{}'", i == 0 ? "'" : i + 1 == names.size() ? " or '" : ", '", names[i]);
    return text;
}

std::string without_number(const std::string& folded_text) {
    const std::size_t last = folded_text.find_last_not_of("0123456789");
    const bool numbered = last != std::string::npos && last + 1 < folded_text.size() && folded_text[last] == ' ';
    return numbered ? folded_text.substr(0, last) : folded_text;
}

std::optional<double> converted(double value, const std::string& from, const std::string& to) {
    if (from == to) return value;
    const auto source = unit_of(from), target = unit_of(to);
    if (!source || !target || source->length != target->length) return std::nullopt;
    return value * (source->factor / target->factor);
}

}  // namespace ostraka
