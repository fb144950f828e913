// Suggestions for misspelt names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Optimal string alignment distance: the minimum number of insertions, deletions, substitutions and swaps of adjacent letters
/// that turn one text into the other; if the distance exceeds `limit`, any number above `limit`. Time: O(length x limit).
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit);

/// The entry of `names` most similar to `name`, ignoring case; the first of several equally similar entries. An entry counts as
/// similar within two edits, or within one edit per three letters of a longer name. If no entry is similar: the only entry with a
/// word that begins with `name` ("seat width" for "width"), or else an empty text.
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

}  // namespace ostraka
