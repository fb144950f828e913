// Words compared as people mean them: case and blanks do not count, near misses are found.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Lower case (Latin, Greek and Cyrillic letters), runs of blanks as one, none at the ends. Accents stay. UTF-8 in and out.
std::string folded(std::string_view text);

/// Up to `maximum` of the candidates that differ from the text, both folded, by no more than one edit in three letters; closest
/// first, then in the order given. Nothing for texts of more than 200 bytes.
std::vector<std::string> near_misses(const std::string& text, const std::vector<std::string>& candidates,
                                     std::size_t maximum = 3);

/// ": did you mean 'a', 'b' or 'c'?" or nothing.
std::string did_you_mean(const std::vector<std::string>& suggestions);

/// "'a', 'b' or 'c'"
std::string alternatives(const std::vector<std::string>& list);

/// What stands before the blank and the number at the end of a folded text, or the text.
std::string without_number(const std::string& folded_text);

/// The value in another unit: lengths (um, mm, cm, dm, m, km, in, ft), their squares, cubes and reciprocals ("mm^2", "1/mm",
/// "1/mm^2"), angles (deg, rad); nothing where the units are not of one kind.
std::optional<double> converted(double value, const std::string& from, const std::string& to);

}  // namespace ostraka
