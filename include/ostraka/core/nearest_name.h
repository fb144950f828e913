// Suggestions for misspelt names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Optimal string alignment distance: the minimum number of insertions, deletions, substitutions and swaps of adjacent letters
/// that turn one text into the other; any number above `limit` if it exceeds `limit`. Time: O(length x limit).
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit);

/// The name most similar to `name`, ignoring case; the first of several equally similar ones. It must be within two edits, or
/// within one edit per three letters of a longer name. Otherwise the only name with a word that begins with `name` ("width" for
/// "seat width"), or an empty text.
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

}  // namespace ostraka
