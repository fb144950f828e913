// Compares texts without regard to case and blanks, and finds similar spellings.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// The text in normal form: lower case (Latin, Greek and Cyrillic letters), runs of blanks reduced to one blank, no blanks at the
/// ends. Accents are kept. Input and output are UTF-8.
std::string folded(std::string_view text);

/// Up to `maximum` of the candidates whose edit distance to the text, both in normal form, is at most one per three letters;
/// closest first, then in the given order. Empty for texts of more than 200 bytes.
std::vector<std::string> near_misses(const std::string& text, const std::vector<std::string>& candidates,
                                     std::size_t maximum = 3);

/// Text that offers suggestions: ": did you mean 'a', 'b' or 'c'?"; empty without suggestions.
std::string did_you_mean(const std::vector<std::string>& suggestions);

/// A list of names as text: "'a', 'b' or 'c'".
std::string alternatives(const std::vector<std::string>& names);

/// Removes a number, and the blank before it, from the end of a text in normal form.
std::string without_number(const std::string& folded_text);

/// Converts a value to another unit: lengths (um, mm, cm, dm, m, km, in, ft), their squares, cubes and reciprocals ("mm^2",
/// "1/mm", "1/mm^2"), angles (deg, rad). Empty for units of different dimensions.
std::optional<double> converted(double value, const std::string& from, const std::string& to);

}  // namespace ostraka
