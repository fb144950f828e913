// Lists of numbers on the command line.
#pragma once

#include "command.h"

#include <charconv>

namespace ostraka::app {

/// The numbers of "12,88"; Error (usage) names the option.
template <class Number>
std::vector<Number> numbers_of(const std::string& text, const std::string& option) {
    std::vector<Number> numbers;
    const char *place = text.data(), *const end = text.data() + text.size();
    while (place != end) {
        Number number{};
        const auto [next, code] = std::from_chars(place, end, number);
        if (code != std::errc() || (next != end && *next != ',') || next + 1 == end)
            fail_usage(option + " is '" + printable(text, 60) + "'", "give numbers with commas between them, like 12,88");
        numbers.push_back(number);
        place = next == end ? end : next + 1;
    }
    if (numbers.empty()) fail_usage(option + " is empty", "give numbers with commas between them");
    return numbers;
}

}  // namespace ostraka::app
