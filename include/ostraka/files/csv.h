// CSV tables (RFC 4180), protected against formula injection.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Protects a cell from being read as a formula by a spreadsheet: puts an apostrophe in front of text that begins with a tab or a
/// line break, or that has one of = + - @ (including their full-width and small forms) at the front or after a semicolon, a tab,
/// a line break or a non-ASCII blank, ignoring plain blanks in between. If `unescape_formula` would remove an apostrophe from
/// the text, a further apostrophe is added, so that unescaping restores every text.
std::string escape_formula(const std::string& text);
/// Inverse of `escape_formula`: removes the apostrophe that protects a cell.
std::string unescape_formula(const std::string& text);

/// One row of a CSV file (RFC 4180) with a line feed at the end. Cells that are not plain numbers are protected by
/// `escape_formula`.
std::string csv_row(const std::vector<std::string>& cells);

/// One row of a CSV file.
struct CsvRow {
    std::size_t line = 0;            ///< number of the line on which the row begins, from 1
    std::vector<std::string> cells;  ///< the cells as in the file, still escaped (unescape_formula)
};
/// The non-empty rows of a CSV file; the cells are still escaped (unescape_formula). A byte order mark is skipped. Throws Error
/// (input), naming file and line, if a quoted cell is not closed or is followed by text.
std::vector<CsvRow> csv_rows(std::string_view text, char separator, const std::string& where);
/// The most frequent separator in the first line of a CSV text: comma, semicolon or tab.
char csv_separator(std::string_view text);

}  // namespace ostraka
