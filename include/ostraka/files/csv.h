// CSV tables (RFC 4180), protected against formula injection.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Protects a cell from being read as a formula by a spreadsheet: puts an apostrophe in front of text that begins with a tab or
/// a line break, or that has one of = + - @ (including their full-width and small forms) at the front or after a semicolon, a
/// tab, a line break or a non-ASCII blank, ignoring plain blanks in between. Text that `unescape_formula` would shorten gets an
/// apostrophe as well.
std::string escape_formula(const std::string& text);
std::string unescape_formula(const std::string& text);

/// One row of a CSV file (RFC 4180) with a line feed at the end. Cells are protected unless they are plain numbers.
std::string csv_row(const std::vector<std::string>& cells);

struct CsvRow {
    std::size_t line = 0;  ///< line on which the row begins, from 1
    std::vector<std::string> cells;
};
/// The non-empty rows of a CSV file; the protection of cells is not removed. A byte order mark is skipped. Throws Error (input),
/// naming file and line, if a quoted cell is not closed or is followed by text.
std::vector<CsvRow> csv_rows(std::string_view text, char separator, const std::string& where);
/// The most frequent separator of the first line: comma, semicolon or tab.
char csv_separator(std::string_view text);

}  // namespace ostraka
