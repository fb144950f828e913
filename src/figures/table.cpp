#include "ostraka/figures/table.h"

#include "ostraka/core/text.h"
#include "ostraka/figures/markdown.h"
#include "ostraka/files/csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace ostraka {

namespace {

/// A single line of printable characters: line breaks and control characters become blanks.
std::string one_line(std::string_view text) { return without_controls(text, " "); }

bool is_number(const std::string& cell) {
    std::string bare = cell;
    while (!bare.empty() && (bare.back() == '%' || bare.back() == ' ')) bare.pop_back();
    return number_of(bare).has_value();
}

/// Escapes text for LaTeX.
std::string latex_text(const std::string& text) {
    static const std::map<char, std::string> names{{'\\', "\\textbackslash{}"},
                                                   {'{', "\\{"},
                                                   {'}', "\\}"},
                                                   {'$', "\\$"},
                                                   {'&', "\\&"},
                                                   {'#', "\\#"},
                                                   {'%', "\\%"},
                                                   {'_', "\\_"},
                                                   {'~', "\\textasciitilde{}"},
                                                   {'^', "\\textasciicircum{}"},
                                                   {'<', "\\textless{}"},
                                                   {'>', "\\textgreater{}"},
                                                   {'|', "\\textbar{}"},
                                                   {'"', "\\textquotedbl{}"},
                                                   {'`', "\\textasciigrave{}"},
                                                   {'-', "{-}"}};
    std::string result;
    const std::string line = one_line(text);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const auto escaped = names.find(line[i]);
        // Consecutive hyphens would become a dash; a single hyphen stays.
        const bool alone = line[i] == '-' && (i == 0 || line[i - 1] != '-') && (i + 1 == line.size() || line[i + 1] != '-');
        if (escaped == names.end() || alone) result += line[i];
        else result += escaped->second;
    }
    return result;
}

TableCell finite_cell(const std::optional<double>& value, const std::function<std::string(double)>& text_of) {
    if (!value || !std::isfinite(*value)) return {"-", {""}};
    return {text_of(*value), {digits(*value)}};
}

}  // namespace

std::string markdown_text(std::string_view text) {
    std::string result;
    for (const char c : one_line(text)) {
        if (c == '<') result += "&lt;";
        else if (c == '>') result += "&gt;";
        else if (c == '&') result += "&amp;";
        else {
            if (std::string_view("\\|`*_[]#~").find(c) != std::string_view::npos) result += '\\';
            result += c;
        }
    }
    return result;
}

std::string markdown_paragraphs(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string line = markdown_text(trimmed(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
        // "- ", "===", and a number with a point would be read as markup.
        const std::size_t number_end = std::min(line.find_first_not_of("0123456789"), line.size());
        const bool is_mark = number_end == 0
                                 ? line.find_first_of("-+=") == 0
                                 : line.find_first_of(".)", number_end) == number_end && (line + " ")[number_end + 1] == ' ';
        if (is_mark) line.insert(number_end, 1, '\\');
        result += (result.empty() ? "" : "\n") + line;
    }
    return result;
}

std::string markdown_file(std::string_view name) {
    std::string result;
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 32 || std::string_view(" <>()\\&%#?\x7f").find(c) != std::string_view::npos)
            result += percent_encoded({&c, 1});
        else result += c;
    return result;
}

TableCell number_cell(const std::optional<double>& value, int digits) {
    return finite_cell(value, [&](double x) { return significant(x, digits); });
}

TableCell fixed_cell(const std::optional<double>& value, int after_point) {
    return finite_cell(value, [&](double x) { return fixed(x, after_point); });
}

TableCell percent_cell(const std::optional<double>& fraction, int after_point) {
    return finite_cell(fraction, [&](double x) { return percent(x, after_point); });
}

std::size_t shown_width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

TextTable::TextTable(const std::vector<TableColumn>& columns) {
    for (const TableColumn& column : columns) {
        columns_.push_back(column.name);
        csv_widths_.push_back(column.csv.size());
        csv_columns_.insert(csv_columns_.end(), column.csv.begin(), column.csv.end());
    }
}

TextTable::TextTable(const std::vector<std::string>& columns)
    : TextTable(std::vector<TableColumn>(columns.begin(), columns.end())) {}

void TextTable::add(const std::vector<TableCell>& cells) {
    if (cells.size() != columns_.size())
        throw std::logic_error(fmt::format("a row of {} cells in a table of {} columns", cells.size(), columns_.size()));
    std::vector<std::string> row, values;
    for (std::size_t j = 0; j < cells.size(); ++j) {
        if (cells[j].csv.size() != csv_widths_[j])
            throw std::logic_error(fmt::format("{} values under '{}', which has {} columns in the CSV", cells[j].csv.size(),
                                               columns_[j], csv_widths_[j]));
        row.push_back(cells[j].text);
        values.insert(values.end(), cells[j].csv.begin(), cells[j].csv.end());
    }
    rows_.push_back(std::move(row));
    csv_rows_.push_back(std::move(values));
}

void TextTable::add(const std::vector<std::string>& cells) { add(std::vector<TableCell>(cells.begin(), cells.end())); }

std::vector<bool> TextTable::numeric() const {
    std::vector<bool> result(columns_.size(), !rows_.empty());
    for (std::size_t j = 0; j < columns_.size(); ++j) {
        bool any = false;
        for (const auto& row : rows_) {
            if (row[j].empty() || row[j] == "-") continue;
            any = true;
            if (!is_number(row[j])) result[j] = false;
        }
        if (!any) result[j] = false;
    }
    return result;
}

std::string TextTable::csv() const {
    std::string text = csv_row(csv_columns_);
    for (const auto& row : csv_rows_) text += csv_row(row);
    return text;
}

std::string TextTable::markdown() const {
    const std::vector<bool> right = numeric();
    std::string text = "|", line = "|";
    for (std::size_t j = 0; j < columns_.size(); ++j)
        text += ' ' + markdown_text(columns_[j]) + " |", line += right[j] ? "---:|" : "---|";
    text += '\n' + line + '\n';
    for (const auto& row : rows_) {
        text += '|';
        for (const std::string& cell : row) text += ' ' + markdown_text(cell) + " |";
        text += '\n';
    }
    return text;
}

std::string TextTable::latex(const std::string& caption, const std::string& label) const {
    const std::vector<bool> right = numeric();
    std::string columns;
    for (const bool r : right) columns += r ? 'r' : 'l';
    const auto row_text = [](const std::vector<std::string>& cells) {
        std::string text;
        for (std::size_t j = 0; j < cells.size(); ++j) text += (j == 0 ? "" : " & ") + latex_text(cells[j]);
        // A bracket at the start of the next row would be read as an argument of the line break.
        return text + " \\\\\\relax\n";
    };
    std::string text = "\\begin{tabular}{" + columns + "}\n\\toprule\n" + row_text(columns_) + "\\midrule\n";
    for (const auto& row : rows_) text += row_text(row);
    text += "\\bottomrule\n\\end{tabular}\n";
    if (caption.empty()) return text;
    return "\\begin{table}\n\\centering\n" + text + "\\caption{" + latex_text(caption) + "}\n" +
           (label.empty() ? "" : fmt::format("\\label{{{}}}\n", label)) + "\\end{table}\n";
}

std::string aligned_rows(const std::vector<std::vector<std::string>>& rows,
                         const std::function<bool(std::size_t, std::size_t)>& right) {
    constexpr std::size_t widest = 100;
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows)
        for (std::size_t j = 0; j < widths.size(); ++j) {
            const std::size_t width = shown_width(row[j]);
            widths[j] = std::max(widths[j], &row == &rows.front() ? width : std::min(width, widest));
        }
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t j = 0; j < widths.size(); ++j) {
            const std::string& cell = rows[i][j];
            const std::string blanks(widths[j] - std::min(widths[j], shown_width(cell)), ' ');
            text += (j == 0 ? "" : "  ") + (right(i, j) ? blanks + cell : cell + blanks);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    return text;
}

std::string TextTable::plain() const {
    std::vector<std::vector<std::string>> rows{columns_};
    rows.insert(rows.end(), rows_.begin(), rows_.end());
    for (auto& row : rows)
        for (std::string& cell : row) cell = one_line(cell);
    return aligned_rows(rows, [right = numeric()](std::size_t, std::size_t column) { return right[column]; });
}

void TextTable::write(const Path& folder, const std::string& name, const std::string& caption) const {
    write_file(folder / (name + ".md"), markdown());
    write_file(folder / (name + ".csv"), csv());
    write_file(folder / (name + ".tex"), latex(caption));
}

std::string fixed(double value, int after_point) {
    std::string text(400, '\0');
    text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.*f", after_point, value)));
    return text.find_first_not_of("-0.") == std::string::npos && text.front() == '-' ? text.substr(1) : text;
}

std::string significant(double value, int digits) { return ostraka::digits(value, digits); }

std::string significant(const std::optional<double>& value, int digits) { return value ? significant(*value, digits) : "-"; }

std::string percent(const std::optional<double>& fraction, int after_point) {
    return fraction ? fixed(100 * *fraction, after_point) + "%" : "-";
}

}  // namespace ostraka
