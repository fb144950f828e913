// Characters and numbers of texts from outside.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// A character of a text and its bytes; U+FFFD and one byte where no UTF-8 character begins.
struct Character {
    char32_t code = 0;
    std::size_t length = 1;
};
Character character_at(std::string_view text, std::size_t at);

/// The characters of a text; a byte at which no UTF-8 character begins stands for itself, `not_utf8` higher.
inline constexpr char32_t not_utf8 = 0x110000;
std::u32string characters(std::string_view text);

/// What steers terminals and the order of letters instead of being shown: U+0000 to U+001F, U+007F to U+009F, and the marks that
/// turn the direction of writing around (U+202A to U+202E, U+2066 to U+2069).
bool is_control(char32_t code);

/// The text with `instead` for each control character.
std::string without_controls(std::string_view text, std::string_view instead);

/// Every byte but letters, digits and -._~ as %XX (RFC 3986).
std::string percent_encoded(std::string_view text);

/// The shortest digits that read back to the same double.
std::string digits(double value);
/// At most so many significant digits, for people.
std::string digits(double value, int significant);
/// The whole of `text`, blanks around it apart, as a finite number.
std::optional<double> number_of(std::string_view text);
std::optional<int> whole_of(std::string_view text);
/// Without blanks around it.
std::string_view trimmed(std::string_view text);
/// With small letters for the capital ones of ASCII.
std::string lower_case(std::string_view text);

/// The line of a text that begins at `at`, without its line feed; `at` moves to the next one.
std::string_view line_at(std::string_view text, std::size_t& at);
/// What stands between blanks, which are these characters.
std::vector<std::string_view> words_of(std::string_view text, std::string_view blanks = " \t\r\n");

}  // namespace ostraka
