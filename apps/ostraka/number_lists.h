// Lists of numbers on the command line.
#pragma once

#include "command.h"

#include <array>
#include <charconv>
#include <cmath>

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

/// The direction "0,0,1", or the axis "z" or "-z"; Error (usage) names the option.
inline std::array<double, 3> direction_of(const std::string& text, const std::string& option) {
    for (std::size_t k = 0; k < 3; ++k)
        for (const double sign : {1.0, -1.0})
            if (text == std::string(sign < 0 ? "-" : "") + "xyz"[k]) {
                std::array<double, 3> axis{0, 0, 0};
                axis.at(k) = sign;
                return axis;
            }
    if (!text.empty() && text.find_first_of("0123456789") == std::string::npos)
        fail_usage(option + " is '" + printable(text, 60) + "'", "use x, y, z, -x, -y, -z or three numbers like 0,1,0");
    const auto numbers = numbers_of<double>(text, option);
    const auto fails = [&](const char* remedy) { fail_usage(option + " is '" + printable(text, 60) + "'", remedy); };
    if (numbers.size() != 3) fails("give three numbers, like 0,0,1");
    for (const double x : numbers)
        if (!std::isfinite(x)) fails("give finite numbers");
    if (numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0) fails("give a vector that is not zero");
    return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace ostraka::app
