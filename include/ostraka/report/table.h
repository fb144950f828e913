// Tables of text and numbers, as CSV, Markdown and LaTeX.
#pragma once

#include "ostraka/core/file.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Cells are plain text, names from outside among them: whatever they hold, they stay text in each format.
class TextTable {
public:
    explicit TextTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}
    /// Throws std::logic_error unless there is a cell a column.
    void add(std::vector<std::string> cells);

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
    [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const { return rows_; }

    /// As RFC 4180 has it, text guarded against being taken for a formula (core/csv.h).
    [[nodiscard]] std::string csv() const;
    /// A pipe table; columns that hold numbers only stand to the right.
    [[nodiscard]] std::string markdown() const;
    /// A tabular of the booktabs package, in a table with this caption and label where there is a caption.
    [[nodiscard]] std::string latex(const std::string& caption = {}, const std::string& label = {}) const;
    /// For a terminal: columns aligned by blanks.
    [[nodiscard]] std::string plain() const;

    /// FOLDER/NAME.md, .csv and .tex.
    void write(const Path& folder, const std::string& name, const std::string& caption = {}) const;

private:
    [[nodiscard]] std::vector<bool> numeric() const;

    std::vector<std::string> columns_;
    std::vector<std::vector<std::string>> rows_;
};

/// Text that LaTeX sets as it stands.
std::string latex_text(const std::string& text);
/// Text that stays text in a cell of a Markdown table.
std::string markdown_text(const std::string& text);

/// With as many digits after the point.
std::string fixed(double value, int after_point);
/// With as many significant digits, without trailing zeros; powers of ten where the number is very large or small.
std::string significant(double value, int digits);
/// The same, or nothing.
std::string significant(const std::optional<double>& value, int digits);
std::string percent(const std::optional<double>& share, int after_point = 1);

}  // namespace ostraka
