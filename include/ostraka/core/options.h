// One field list per options struct: it gives the flag, the JSON key, the help line and the range check.
//
// An options struct has a member template
//     template <class Visitor> void describe(Visitor& visit) {
//         visit("max-distance", max_distance, "farthest a correspondence may lie, as a share of the box diagonal", Range{0, 1});
//         visit("metric", metric, "distance that paths minimise", Choices{"euclidean", "segment", "combined"});
//     }
// with members of type bool, int, double, std::string or std::uint64_t.
#pragma once

#include "ostraka/core/error.h"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

struct Range {
    double min, max;
};
struct Choices {
    std::vector<std::string> names;
    Choices(std::initializer_list<std::string> list) : names(list) {}
    explicit Choices(std::vector<std::string> list) : names(std::move(list)) {}
};
struct Anything {};

namespace detail {
struct CheckVisitor {
    std::string where;
    void operator()(const char* name, const double& value, const char*, Range range) const {
        if (!(value >= range.min && value <= range.max)) out_of_range(name, std::to_string(value), range);
    }
    void operator()(const char* name, const int& value, const char*, Range range) const {
        if (value < range.min || value > range.max) out_of_range(name, std::to_string(value), range);
    }
    void operator()(const char* name, const std::uint64_t& value, const char*, Range range) const {
        const auto v = static_cast<double>(value);
        if (v < range.min || v > range.max) out_of_range(name, std::to_string(value), range);
    }
    void operator()(const char* name, const std::string& value, const char*, const Choices& choices) const {
        if (std::find(choices.names.begin(), choices.names.end(), value) != choices.names.end()) return;
        std::string list;
        for (const auto& choice : choices.names) list += (list.empty() ? "" : ", ") + choice;
        throw Error(ErrorKind::usage, where, "option " + std::string(name) + " is '" + value + "'", "use one of: " + list);
    }
    template <class T>
    void operator()(const char*, const T&, const char*, Anything) const {}

private:
    void out_of_range(const char* name, const std::string& value, Range range) const {
        std::ostringstream text;
        text << "use a value from " << range.min << " to " << range.max;
        throw Error(ErrorKind::usage, where, "option " + std::string(name) + " is " + value, text.str());
    }
};

struct ListVisitor {
    std::vector<std::pair<std::string, std::string>> list;
    template <class T, class Rule>
    void operator()(const char* name, const T& value, const char*, const Rule&) {
        std::ostringstream text;
        text.precision(17);
        text << std::boolalpha << value;
        list.emplace_back(name, text.str());
    }
};
}  // namespace detail

/// Throws Error (usage) that names the option, its value and what is allowed.
template <class Options>
void check_options(const Options& options, const std::string& where) {
    detail::CheckVisitor visitor{where};
    const_cast<Options&>(options).describe(visitor);
}

/// Names and values as text, for provenance.
template <class Options>
std::vector<std::pair<std::string, std::string>> list_options(const Options& options) {
    detail::ListVisitor visitor;
    const_cast<Options&>(options).describe(visitor);
    return std::move(visitor.list);
}

}  // namespace ostraka
