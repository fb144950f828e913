// CSV tables (RFC 4180), and nothing in them that can become a formula.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

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

}  // namespace ostraka
