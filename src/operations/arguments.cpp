#include "operations/operations.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ostraka {

template <class Number>
std::vector<Number> numbers_of(const std::string& text, const std::string& option) {
    std::vector<Number> numbers;
    const char *place = text.data(), *const end = text.data() + text.size();
    while (place != end) {
        Number value{};
        const auto [next, code] = std::from_chars(place, end, value);
        if (code != std::errc() || (next != end && *next != ',') || next + 1 == end)
            fail_usage(fmt::format("{} is '{}'", option, printable(text, 60)),
                       "give numbers with commas between them, like 12,88");
        numbers.push_back(value);
        place = next == end ? end : next + 1;
    }
    if (numbers.empty()) fail_usage(option + " is empty", "give numbers with commas between them");
    return numbers;
}
template std::vector<double> numbers_of<double>(const std::string&, const std::string&);
template std::vector<std::uint32_t> numbers_of<std::uint32_t>(const std::string&, const std::string&);

std::array<double, 3> direction_of(const std::string& text, const std::string& option) {
    for (std::size_t k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0})
            if (text == std::string(sign < 0 ? "-" : "") + "xyz"[k]) {
                std::array<double, 3> axis{0, 0, 0};
                axis.at(k) = sign;
                return axis;
            }
    const auto fail = [&](const char* remedy) { fail_usage(fmt::format("{} is '{}'", option, printable(text, 60)), remedy); };
    const auto numbers = numbers_of<double>(text, option);
    if (numbers.size() != 3) fail("give three numbers, like 0,0,1");
    for (const double x : numbers)
        if (!std::isfinite(x)) fail("give finite numbers");
    if (numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0) fail("give a vector that is not zero");
    return {numbers[0], numbers[1], numbers[2]};
}

Words direction_words(const std::string& option, std::vector<std::string> more) {
    Words rule{more, "three numbers like 0,0,1"};
    for (const char* axis : {"x", "y", "z", "-x", "-y", "-z"}) rule.names.emplace_back(axis);
    rule.check = [option, names = rule.names, others = rule.others](const std::string& text) {
        if (std::find(names.begin(), names.end(), text) != names.end()) return;
        if (text.find_first_of("0123456789,") == std::string::npos)
            fail_usage(fmt::format("{} is '{}'", option, printable(text, 60)),
                       fmt::format("use {} or {}", joined(names), others));
        static_cast<void>(direction_of(text, option));
    };
    return rule;
}

void DirectionOption::declare(Parameters& p, const std::string& help) { p.options("up", text_, help, direction_words("--up")); }

std::optional<std::array<double, 3>> DirectionOption::value() const {
    return text_.empty() ? std::nullopt : std::optional(direction_of(text_, "--up"));
}

const Annotation& find_annotation(const AnnotationSet& set, const std::string& name, const std::string& file) {
    int id = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), id);
    if (code == std::errc() && end == name.data() + name.size())
        if (const Annotation* annotation = set.find(id)) return *annotation;
    std::vector<const Annotation*> tagged;
    for (const Annotation& annotation : set.annotations)
        if (annotation.tag == name) tagged.push_back(&annotation);
    if (tagged.empty()) fail_unknown_annotation(set, name, file);
    if (tagged.size() > 1)
        fail_input(file, fmt::format("has {} annotations tagged '{}'", tagged.size(), printable(name, 60)), "give the id of one");
    return *tagged.front();
}

}  // namespace ostraka
