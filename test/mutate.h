// Reproducibly damaged copies of files, to test the robustness of readers.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace ostraka::test {

namespace detail {

inline std::size_t below(std::mt19937_64& random, std::size_t count) {
    return count == 0 ? 0 : static_cast<std::size_t>(random() % count);
}

/// Begin and end of each piece of `bytes` between separators.
inline std::vector<std::pair<std::size_t, std::size_t>> pieces(const std::string& bytes, const std::string& separators) {
    std::vector<std::pair<std::size_t, std::size_t>> list;
    for (std::size_t i = 0; i < bytes.size();) {
        const std::size_t begin = bytes.find_first_not_of(separators, i);
        if (begin == std::string::npos) break;
        const std::size_t end = std::min(bytes.find_first_of(separators, begin), bytes.size());
        list.emplace_back(begin, end);
        i = end;
    }
    return list;
}

inline std::string pick_word(std::mt19937_64& random) {
    static const std::vector<std::string> words{"nan",
                                                "-inf",
                                                "1e400",
                                                "1e-400",
                                                "-1",
                                                "0",
                                                "4294967295",
                                                "4294967296",
                                                "-9223372036854775808",
                                                "99999999999999999999",
                                                "3000000000",
                                                "0x10",
                                                "",
                                                "1.5",
                                                "\"",
                                                "{",
                                                "]",
                                                "null",
                                                "true",
                                                "/",
                                                "\\",
                                                "\xff\xfe",
                                                "1000000000",
                                                "-0",
                                                "#",
                                                "65536",
                                                "1e99",
                                                "2//",
                                                std::string(300, '9'),
                                                std::string(1, '\0')};
    return words[below(random, words.size())];
}

}  // namespace detail

/// Copy number `seed` of `bytes` with one to eight mutations: flipped bytes or bits, a truncated end, a removed, duplicated or
/// zeroed range, a word (between blanks or punctuation) or a line removed, duplicated, swapped or replaced by a value that
/// readers often mishandle.
inline std::string mutate(const std::string& bytes, std::uint64_t seed) {
    using detail::below;
    std::mt19937_64 random(seed * 0x9E3779B97F4A7C15U + 1);
    std::string text = bytes;
    const std::size_t injuries = 1 + below(random, 4) * below(random, 3);
    for (std::size_t i = 0; i < injuries && !text.empty(); ++i) {
        const std::size_t at = below(random, text.size()), length = std::min(1 + below(random, 40), text.size() - at);
        const bool by_line = below(random, 3) == 0;
        const auto parts = detail::pieces(text, by_line ? "\n" : " \t\r\n,:;[]{}\"/");
        const auto part =
            parts.empty() ? std::pair<std::size_t, std::size_t>{at, at + length} : parts[below(random, parts.size())];
        const auto other = parts.empty() ? part : parts[below(random, parts.size())];
        const std::string word = text.substr(part.first, part.second - part.first);
        switch (below(random, 10)) {
            case 0:
                text[at] = static_cast<char>(random());
                break;
            case 1:
                text[at] = static_cast<char>(text[at] ^ (1 << below(random, 8)));
                break;
            case 2:
                text.resize(at);
                break;
            case 3:
                text.erase(at, length);
                break;
            case 4:
                text.insert(at, text.substr(at, length));
                break;
            case 5:
                std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(at), length, below(random, 2) == 0 ? '\0' : '\xff');
                break;
            case 6:
                text.erase(part.first, part.second - part.first);
                break;
            case 7:
                text.insert(part.first, word + (by_line ? "\n" : " "));
                break;
            case 8:
                text.replace(part.first, part.second - part.first, detail::pick_word(random));
                break;
            default:
                text.replace(part.first, part.second - part.first, text.substr(other.first, other.second - other.first));
                break;
        }
    }
    return text;
}

}  // namespace ostraka::test
