// Text in and out of the formats of others: cells, numbers, and nothing that can become a formula, markup or a script.
#pragma once

#include "ostraka/core/json.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka::exchange {

/// Text whose bytes are not UTF-8 has U+FFFD for each byte that does not fit.
std::string as_utf8(std::string_view text);
/// The shortest digits that read back to the same double.
std::string digits(double value);
/// The whole of `text`, blanks around it apart, as a finite number.
std::optional<double> number_of(std::string_view text);
std::optional<int> whole_of(std::string_view text);
/// Without blanks around it.
std::string_view trimmed(std::string_view text);
std::string lower(std::string_view text);
/// Control characters (core/text.h), line breaks among them, as blanks, for formats that keep a record on a line.
std::string one_line(std::string_view text);
/// True if `one_line` would change the text.
bool has_control(std::string_view text);

/// A cell that no spreadsheet takes for a formula: text that begins with a tab or a line break, or in which one of = + - @, also
/// in their wide and small forms, stands at the front or behind a semicolon, a tab, a line break or a special blank (plain blanks
/// between apart) gets an apostrophe in front, and so does text that `unguarded` would shorten.
std::string guarded(const std::string& text);
std::string unguarded(const std::string& text);

/// One row of a CSV file (RFC 4180), guarded unless a cell is a plain number, ended by a line feed.
std::string csv_row(const std::vector<std::string>& cells);

struct CsvRow {
    std::size_t line = 0;  ///< where it begins, from 1
    std::vector<std::string> cells;
};
/// Rows of a CSV file, empty ones left out; cells as they stand, not unguarded. A byte order mark is skipped. Throws Error
/// (input) naming file and line where a quoted cell does not end or is followed by text.
std::vector<CsvRow> csv_rows(std::string_view text, char separator, const std::string& where);
/// The separator among comma, semicolon and tab that the first line has most of.
char csv_separator(std::string_view text);

/// JSON as `to_text`, with < > & as escapes: it may stand inside an HTML page without ending its script.
std::string json_text(const JsonValue& value);

/// Member that is a string, or empty.
std::string text_member(const JsonValue& object, std::string_view name);
/// A list of three finite numbers, or nothing.
std::optional<std::array<double, 3>> triple(const JsonValue* value);
JsonValue triple_json(const std::array<double, 3>& values, JsonAllocator& allocator);

}  // namespace ostraka::exchange
