// Tables of text and numbers, as CSV, Markdown and LaTeX.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A cell: the displayed text and the CSV values. In the CSV, numbers have all their digits and missing values are empty.
struct TableCell {
    std::string text;
    std::vector<std::string> csv;  ///< one value for each CSV column of the table's column

    TableCell(std::string content) : text(std::move(content)), csv{text} {}
    TableCell(const char* content) : TableCell(std::string(content)) {}
    TableCell(std::string displayed, std::vector<std::string> values) : text(std::move(displayed)), csv(std::move(values)) {}
};
/// Numbers formatted for display by `significant`, `fixed` and `percent`, "-" if missing or not finite. A percentage is a
/// fraction in the CSV.
TableCell number_cell(const std::optional<double>& value, int digits);
TableCell fixed_cell(const std::optional<double>& value, int after_point);
TableCell percent_cell(const std::optional<double>& fraction, int after_point = 1);

/// A column, which may be several columns in the CSV, such as the two ends of an interval.
struct TableColumn {
    std::string name;
    std::vector<std::string> csv;

    TableColumn(std::string title) : name(std::move(title)), csv{name} {}
    TableColumn(const char* title) : TableColumn(std::string(title)) {}
    TableColumn(std::string displayed, std::vector<std::string> names) : name(std::move(displayed)), csv(std::move(names)) {}
};

/// Cells are plain text, possibly untrusted: they are escaped in each format.
class TextTable {
public:
    explicit TextTable(std::initializer_list<TableColumn> columns) : TextTable(std::vector<TableColumn>(columns)) {}
    explicit TextTable(const std::vector<TableColumn>& columns);
    explicit TextTable(const std::vector<std::string>& columns);
    /// Throws std::logic_error unless there is one cell per column, with a value for each of its CSV columns.
    void add(std::initializer_list<TableCell> cells) { add(std::vector<TableCell>(cells)); }
    void add(const std::vector<TableCell>& cells);
    void add(const std::vector<std::string>& cells);

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
    [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const { return rows_; }

    /// CSV by RFC 4180, with text protected from being read as a formula (core/csv.h).
    [[nodiscard]] std::string csv() const;
    /// A pipe table; numeric columns are right-aligned.
    [[nodiscard]] std::string markdown() const;
    /// A tabular of the booktabs package; with a caption, within a table with this caption and label.
    [[nodiscard]] std::string latex(const std::string& caption = {}, const std::string& label = {}) const;
    /// For a terminal, like `aligned_rows`; numeric columns are right-aligned.
    [[nodiscard]] std::string plain() const;

    /// Writes FOLDER/NAME.md, .csv and .tex.
    void write(const Path& folder, const std::string& name, const std::string& caption = {}) const;

private:
    [[nodiscard]] std::vector<bool> numeric() const;

    std::vector<std::string> columns_, csv_columns_;
    std::vector<std::size_t> csv_widths_;  ///< one per column: number of its CSV columns
    std::vector<std::vector<std::string>> rows_, csv_rows_;
};

/// Formats rows for a terminal; the first is the header. Columns are padded with blanks and no text is cut; a cell of more than
/// 100 characters shifts only the rest of its own row. right(row, column): whether the cell is right-aligned.
std::string aligned_rows(const std::vector<std::vector<std::string>>& rows,
                         const std::function<bool(std::size_t, std::size_t)>& right);
/// Display width in terminal columns, not bytes: continuation bytes of UTF-8 have no width.
std::size_t shown_width(const std::string& text);

/// With this number of digits after the decimal point.
std::string fixed(double value, int after_point);
/// With this number of significant digits, without trailing zeros; in exponential notation for very large or small numbers.
std::string significant(double value, int digits);
/// The same; empty if there is no value.
std::string significant(const std::optional<double>& value, int digits);
std::string percent(const std::optional<double>& fraction, int after_point = 1);

}  // namespace ostraka
