// Tables of text and numbers, as CSV, Markdown and LaTeX.
#pragma once

#include "ostraka/core/file.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A cell: what people read, and what stands in the CSV, where numbers have all their digits and nothing stands for what is
/// missing.
struct TableCell {
    std::string text;
    std::vector<std::string> csv;  ///< a value for each column of the CSV that the table's column has

    TableCell(std::string both) : text(std::move(both)), csv{text} {}
    TableCell(const char* both) : TableCell(std::string(both)) {}
    TableCell(std::string shown, std::vector<std::string> values) : text(std::move(shown)), csv(std::move(values)) {}
};
/// Numbers for people as `significant`, `fixed` and `percent` write them, "-" where there is none or it is not finite. A
/// percentage is a share in the CSV.
TableCell number_cell(const std::optional<double>& value, int digits);
TableCell fixed_cell(const std::optional<double>& value, int after_point);
TableCell percent_cell(const std::optional<double>& share, int after_point = 1);

/// A column, which may be several in the CSV, such as the two ends of an interval.
struct TableColumn {
    std::string name;
    std::vector<std::string> csv;

    TableColumn(std::string both) : name(std::move(both)), csv{name} {}
    TableColumn(const char* both) : TableColumn(std::string(both)) {}
    TableColumn(std::string shown, std::vector<std::string> names) : name(std::move(shown)), csv(std::move(names)) {}
};

/// Cells are plain text, names from outside among them: whatever they hold, they stay text in each format.
class TextTable {
public:
    explicit TextTable(std::initializer_list<TableColumn> columns) : TextTable(std::vector<TableColumn>(columns)) {}
    explicit TextTable(const std::vector<TableColumn>& columns);
    explicit TextTable(const std::vector<std::string>& columns);
    /// Throws std::logic_error unless there is a cell a column, with a value for each of its columns in the CSV.
    void add(std::initializer_list<TableCell> cells) { add(std::vector<TableCell>(cells)); }
    void add(const std::vector<TableCell>& cells);
    void add(const std::vector<std::string>& cells);

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
    [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const { return rows_; }

    /// As RFC 4180 has it, text guarded against being taken for a formula (core/csv.h).
    [[nodiscard]] std::string csv() const;
    /// A pipe table; columns that hold numbers only stand to the right.
    [[nodiscard]] std::string markdown() const;
    /// A tabular of the booktabs package, in a table with this caption and label where there is a caption.
    [[nodiscard]] std::string latex(const std::string& caption = {}, const std::string& label = {}) const;
    /// For a terminal, as `aligned_rows`; columns that hold numbers only stand to the right.
    [[nodiscard]] std::string plain() const;

    /// FOLDER/NAME.md, .csv and .tex.
    void write(const Path& folder, const std::string& name, const std::string& caption = {}) const;

private:
    [[nodiscard]] std::vector<bool> numeric() const;

    std::vector<std::string> columns_, csv_columns_;
    std::vector<std::size_t> csv_widths_;  ///< a column: its columns in the CSV
    std::vector<std::vector<std::string>> rows_, csv_rows_;
};

/// Rows, of which the first is the header, for a terminal: columns padded with blanks, no text cut; a cell of more than 100
/// characters pushes the rest of its own row aside only. right(row, column): whether the cell stands to the right.
std::string aligned_rows(const std::vector<std::vector<std::string>>& rows,
                         const std::function<bool(std::size_t, std::size_t)>& right);
/// Columns on a terminal, not bytes: continuation bytes of UTF-8 take no room.
std::size_t shown_width(const std::string& text);

/// With as many digits after the point.
std::string fixed(double value, int after_point);
/// With as many significant digits, without trailing zeros; powers of ten where the number is very large or small.
std::string significant(double value, int digits);
/// The same, or nothing.
std::string significant(const std::optional<double>& value, int digits);
std::string percent(const std::optional<double>& share, int after_point = 1);

}  // namespace ostraka
