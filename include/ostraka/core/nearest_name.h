// Names that people may have meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Fewest insertions, deletions, replacements of letters and swaps of neighbours (optimal string alignment) from one text to
/// the other, or more than `limit` where it is more. Time: length x limit.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit);

/// Of several names the one that is nearest to what was written, capital letters or not, the first of equally near ones; else the
/// only one in which a word begins so ("width" for "seat width"); empty where none is near: within two edits, or one in three
/// letters.
std::string nearest_name(const std::string& name, const std::vector<std::string>& names);

}  // namespace ostraka
