// Tables of text and numbers, as CSV, Markdown and LaTeX.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A cell of a table: the displayed text and the CSV values. In the CSV, numbers have all digits and missing values are empty.
struct TableCell {
    std::string text;              ///< displayed text
    std::vector<std::string> csv;  ///< CSV values of the cell, one for each CSV column of its table column

    TableCell(std::string content) : text(std::move(content)), csv{text} {}
    TableCell(const char* content) : TableCell(std::string(content)) {}
    TableCell(std::string displayed, std::vector<std::string> values) : text(std::move(displayed)), csv(std::move(values)) {}
};
/// A cell with a number, displayed with `digits` significant digits; "-" if missing or not finite.
TableCell number_cell(const std::optional<double>& value, int digits);
/// A cell with a number, displayed with `after_point` digits after the decimal point; "-" if missing or not finite.
TableCell fixed_cell(const std::optional<double>& value, int after_point);
/// A cell with a fraction, displayed in per cent and written to the CSV as a fraction; "-" if missing or not finite.
TableCell percent_cell(const std::optional<double>& fraction, int after_point = 1);

/// A column of a table. In the CSV, a table column may be several columns, such as the two ends of an interval.
struct TableColumn {
    std::string name;              ///< displayed heading
    std::vector<std::string> csv;  ///< headings of the CSV columns

    TableColumn(std::string title) : name(std::move(title)), csv{name} {}
    TableColumn(const char* title) : TableColumn(std::string(title)) {}
    TableColumn(std::string displayed, std::vector<std::string> names) : name(std::move(displayed)), csv(std::move(names)) {}
};

/// A table of text. Cells may be untrusted text, which is escaped in each format.
class TextTable {
public:
    explicit TextTable(std::initializer_list<TableColumn> columns) : TextTable(std::vector<TableColumn>(columns)) {}
    explicit TextTable(const std::vector<TableColumn>& columns);
    explicit TextTable(const std::vector<std::string>& columns);
    /// Appends a row. Throws std::logic_error unless there is one cell per column, with a value for each CSV column of the
    /// column.
    void add(std::initializer_list<TableCell> cells) { add(std::vector<TableCell>(cells)); }
    void add(const std::vector<TableCell>& cells);
    void add(const std::vector<std::string>& cells);

    [[nodiscard]] std::size_t size() const { return rows_.size(); }                            ///< number of rows
    [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }         ///< displayed headings
    [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const { return rows_; }  ///< displayed texts

    /// The table as CSV (RFC 4180), with text protected from being read as a formula (files/csv.h).
    [[nodiscard]] std::string csv() const;
    /// The table as a Markdown pipe table; numeric columns are right-aligned.
    [[nodiscard]] std::string markdown() const;
    /// The table as a LaTeX tabular with the booktabs package; if a caption is given, inside a table environment with this
    /// caption and label.
    [[nodiscard]] std::string latex(const std::string& caption = {}, const std::string& label = {}) const;
    /// The table as text for a terminal (`aligned_rows`); numeric columns are right-aligned.
    [[nodiscard]] std::string plain() const;

    /// Writes FOLDER/NAME.md, .csv and .tex.
    void write(const Path& folder, const std::string& name, const std::string& caption = {}) const;

private:
    [[nodiscard]] std::vector<bool> numeric() const;

    std::vector<std::string> columns_, csv_columns_;
    std::vector<std::size_t> csv_widths_;  ///< one per column: number of its CSV columns
    std::vector<std::vector<std::string>> rows_, csv_rows_;
};

/// Formats rows for a terminal; the first is the header. Columns are padded with blanks, and no text is truncated; a cell of
/// more than 100 characters does not widen its column but shifts the rest of its row. right(row, column): true if the cell is
/// right-aligned.
std::string aligned_rows(const std::vector<std::vector<std::string>>& rows,
                         const std::function<bool(std::size_t, std::size_t)>& right);
/// Display width of a text in terminal columns, not bytes: continuation bytes of UTF-8 have no width.
std::size_t shown_width(const std::string& text);

/// The number as text with `after_point` digits after the decimal point.
std::string fixed(double value, int after_point);
/// The number as text with `digits` significant digits, without trailing zeros; in exponential notation for very large or very
/// small numbers.
std::string significant(double value, int digits);
/// The number as text with `digits` significant digits; an empty text if there is no value.
std::string significant(const std::optional<double>& value, int digits);
/// A fraction as text in per cent; an empty text if there is no value.
std::string percent(const std::optional<double>& fraction, int after_point = 1);

}  // namespace ostraka
