#include "ostraka/morphometrics/shape_sample.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <map>
#include <set>

namespace ostraka {

Landmarks rows_of(const Landmarks& configuration, const std::vector<std::size_t>& rows) {
    Landmarks result(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i)
        result.row(static_cast<Eigen::Index>(i)) = configuration.row(static_cast<Eigen::Index>(rows[i]));
    return result;
}

Landmarks relabelled_mirror(const Landmarks& configuration, const LandmarkPairs& pairs) {
    Landmarks mirror = configuration;
    mirror.col(0) *= -1;
    std::set<std::size_t> used;
    for (const auto& [a, b] : pairs.pairs) {
        for (const std::size_t landmark : {a, b}) {
            if (landmark >= static_cast<std::size_t>(configuration.rows()))
                fail_input("pairs", fmt::format("there is no landmark {}", landmark + 1), "name landmarks of the specimens");
            if (!used.insert(landmark).second)
                fail_input("pairs", fmt::format("landmark {} is in two pairs", landmark + 1), "list each landmark once");
        }
        mirror.row(static_cast<Eigen::Index>(a)).swap(mirror.row(static_cast<Eigen::Index>(b)));
    }
    return mirror;
}

namespace {

/// The name with each word "left" or "l" replaced by "right" or "r"; `changed`: the number of replaced words.
std::string on_the_right(const std::string& name, int& changed) {
    const std::string lower = lower_case(name);
    std::string result, word;
    changed = 0;
    const auto end_word = [&] {
        if (word == "left" || word == "l") ++changed, result += word == "l" ? "r" : "right";
        else result += word;
        word.clear();
    };
    for (const char c : lower) {
        if (c == ' ' || c == '.' || c == '_' || c == '-' || c == '(' || c == ')') end_word(), result += c;
        else word += c;
    }
    end_word();
    return result;
}

}  // namespace

LandmarkPairs pairs_by_name(const std::vector<std::string>& landmarks) {
    std::map<std::string, std::size_t> index;
    for (std::size_t k = 0; k < landmarks.size(); ++k) index.emplace(lower_case(landmarks[k]), k);
    LandmarkPairs result;
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
        int changed = 0;
        const std::string counterpart = on_the_right(landmarks[k], changed);
        if (changed != 1) continue;
        if (const auto other = index.find(counterpart); other != index.end()) result.pairs.push_back({k, other->second});
    }
    return result;
}

}  // namespace ostraka
