#include "ostraka/core/nearest_name.h"

#include "ostraka/core/text.h"

#include <algorithm>
#include <numeric>

namespace ostraka {

std::size_t edit_distance(std::string_view first, std::string_view second, std::size_t limit) {
    const std::u32string a = characters(first), b = characters(second);
    const std::size_t longer = std::max(a.size(), b.size()), shorter = std::min(a.size(), b.size());
    if (longer - shorter > limit) return limit + 1;
    // Rows of the table: the last but one, the last, and the current one; only cells within `limit` of the diagonal are filled.
    std::vector<std::size_t> second_last(b.size() + 1, limit + 1), last(b.size() + 1), row(b.size() + 1, limit + 1);
    std::iota(last.begin(), last.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        const std::size_t begin = i > limit ? i - limit : 1, end = std::min(b.size(), i + limit);
        row.assign(b.size() + 1, limit + 1);
        if (i <= limit) row[0] = i;
        std::size_t best = row[0];
        for (std::size_t j = begin; j <= end; ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], second_last[j - 2] + 1);
            best = std::min(best, row[j]);
        }
        if (best > limit) return limit + 1;
        std::swap(second_last, last);
        std::swap(last, row);
    }
    return std::min(last[b.size()], limit + 1);
}

namespace {

/// The only name with a word that begins with this text; empty if none or several have one.
std::string unique_name_with_word(const std::string& text, const std::vector<std::string>& names) {
    std::string match;
    for (const std::string& candidate : names) {
        const std::string lowered = lower_case(candidate);
        std::size_t position = lowered.find(text);
        while (position != std::string::npos && position > 0 && lowered[position - 1] != ' ' && lowered[position - 1] != '-')
            position = lowered.find(text, position + 1);
        if (position == std::string::npos) continue;
        if (!match.empty() && match != candidate) return {};
        match = candidate;
    }
    return match;
}

}  // namespace

std::string nearest_name(const std::string& name, const std::vector<std::string>& names) {
    const std::string lowered_name = lower_case(name);
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const std::string& candidate : names)
        if (const std::size_t distance = edit_distance(lowered_name, lower_case(candidate), best_distance - 1);
            distance < best_distance)
            best_distance = distance, best = candidate;
    return best.empty() && name.size() > 2 ? unique_name_with_word(lowered_name, names) : best;
}

}  // namespace ostraka
