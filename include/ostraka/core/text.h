// Characters and numbers in text from files and command lines.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// A character of a UTF-8 text.
struct Character {
    char32_t code = 0;       ///< code point; U+FFFD for a byte at which no valid UTF-8 character begins
    std::size_t length = 1;  ///< number of bytes; 1 if invalid
};
/// The character that begins at the byte `position`.
Character character_at(std::string_view text, std::size_t position);

/// Added to the value of a byte at which no valid UTF-8 character begins.
inline constexpr char32_t not_utf8 = 0x110000;
/// The code points of a UTF-8 text; a byte at which no valid UTF-8 character begins becomes its value plus `not_utf8`.
std::u32string characters(std::string_view text);

/// True for control characters, which steer a terminal or change the order of letters: U+0000 to U+001F, U+007F to U+009F, and
/// the bidirectional formatting characters (U+202A to U+202E, U+2066 to U+2069).
bool is_control(char32_t code);

/// The text with each control character replaced by `replacement`.
std::string without_controls(std::string_view text, std::string_view replacement);

/// Percent-encoding: every byte except letters, digits and -._~ as %XX (RFC 3986).
std::string percent_encoded(std::string_view text);

/// The shortest decimal text that reads back to the same double.
std::string digits(double value);
/// The number rounded to at most `significant` digits, for display.
std::string digits(double value, int significant);
/// The text as a finite number, ignoring blanks at both ends; nullopt if the whole text is not a number.
std::optional<double> number_of(std::string_view text);
std::optional<int> parse_int(std::string_view text);  ///< nullopt if the whole text is not an integer
/// The text without leading and trailing blanks.
std::string_view trimmed(std::string_view text);
/// The text with ASCII capital letters in lower case.
std::string lower_case(std::string_view text);

/// The line that begins at `position`, without its line feed; moves `position` to the next line.
std::string_view line_at(std::string_view text, std::size_t& position);
/// The words of a text, separated by characters in `blanks`.
std::vector<std::string_view> split_words(std::string_view text, std::string_view blanks = " \t\r\n");

}  // namespace ostraka
