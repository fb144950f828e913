// Points as lines of numbers: XYZ dialects and PTS, with or without a header that names the columns.
#include "point_cloud/cloud_columns.h"
#include "point_cloud/cloud_formats.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

namespace ostraka::clouds {

namespace {

/// The numbers of a text file, row by row, before their meaning is known.
struct TextRows {
    std::vector<std::string> header;  ///< names of the columns; empty: none
    std::size_t columns = 0;
    std::vector<double> values;
    double stated_count = -1;  ///< number of points that the file states; negative: none
    bool decimal_comma = false;

    [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// The words of a header line, without quotes and comment marks; separated by commas, semicolons or tabs if there are any.
std::vector<std::string> header_words(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of("#/%! \t"), line.size()));
    const bool separated = line.find_first_of(",;\t") != std::string_view::npos;
    std::vector<std::string> words;
    for (const std::string_view word : split_words(line, separated ? ",;\t\r\n" : " \r\n")) {
        const std::string_view plain = trimmed(word);
        if (words.size() >= 1000) break;
        words.emplace_back(plain.substr(0, 80));
    }
    return words;
}

bool names_coordinates(const std::vector<std::string>& words) {
    std::vector<Column> columns;
    for (const std::string& word : words) columns.push_back(column_named(word));
    for (const Column axis : {Column::x, Column::y, Column::z})
        if (column_index(columns, axis) == columns.size()) return false;
    return true;
}

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

/// True for a line such as "1,5;2,5;3": semicolons separate, and no field has more than one comma.
bool has_decimal_commas(std::string_view line) {
    if (line.find(';') == std::string_view::npos || line.find(',') == std::string_view::npos) return false;
    const auto fields = split_words(line, ";");
    return fields.size() >= 3 && std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
               return std::count(field.begin(), field.end(), ',') <= 1;
           });
}

/// Takes a line before the first point that is no row of numbers; true if it was a header or a title in quotes or letters.
bool take_header(std::string_view line, TextRows& table) {
    const auto first = static_cast<unsigned char>(line.front());
    if (std::isalpha(first) == 0 && first != '"' && first != '\'') return false;
    const std::vector<std::string> words = header_words(line);
    if (!table.header.empty() || words.size() < 3) return false;
    table.header = words;
    return true;
}

void read_rows(CloudLines& lines, bool is_pts, TextRows& table) {
    const char* remedy = "give x y z, or x y z nx ny nz, or x y z red green blue, a line";
    std::vector<double> numbers;
    CancelCheck check;
    while (lines.next()) {
        check();
        const bool is_first = table.values.empty();
        if (is_comment(lines.text())) {
            if (!is_first || !table.header.empty()) continue;
            if (const auto words = header_words(lines.text()); names_coordinates(words)) table.header = words;
            continue;
        }
        if (is_first) table.decimal_comma = has_decimal_commas(lines.text());
        if (!lines.numbers(numbers, table.decimal_comma)) {
            if (is_first && take_header(lines.text(), table)) continue;
            fail_input(lines.place(), "is not a list of numbers", remedy);
        }
        if (numbers.size() == 1 && (is_pts || (is_first && table.stated_count < 0))) {  // a count of points
            table.stated_count = std::max(table.stated_count, 0.0) + numbers[0];
            continue;
        }
        if (numbers.size() < 3) fail_input(lines.place(), "has fewer than three numbers", remedy);
        if (table.columns == 0) table.columns = numbers.size();
        if (numbers.size() != table.columns)
            fail_input(lines.place(), fmt::format("has {} numbers, the first line {}", numbers.size(), table.columns),
                       "give every line the same columns");
        table.values.insert(table.values.end(), numbers.begin(), numbers.end());
    }
}

/// True if three columns are unit vectors in every row (or null, but not all).
bool are_normals(const TextRows& table, std::size_t first) {
    std::size_t unit_count = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double a = table.at(row, first), b = table.at(row, first + 1), c = table.at(row, first + 2);
        const double squared = a * a + b * b + c * c;
        if (squared == 0) continue;
        if (!(std::abs(squared - 1) < 0.1)) return false;
        ++unit_count;
    }
    return 2 * unit_count > table.rows();
}

/// True if three columns are whole numbers from 0 to 255 in every row.
bool are_bytes(const TextRows& table, std::size_t first) {
    for (std::size_t row = 0; row < table.rows(); ++row)
        for (std::size_t k = first; k < first + 3; ++k)
            if (const double value = table.at(row, k); !(value >= 0 && value <= 255) || value != std::floor(value)) return false;
    return true;
}

/// True if three columns are numbers from 0 to 1 in every row.
bool are_fractions(const TextRows& table, std::size_t first) {
    for (std::size_t row = 0; row < table.rows(); ++row)
        for (std::size_t k = first; k < first + 3; ++k)
            if (const double value = table.at(row, k); !(value >= 0 && value <= 1)) return false;
    return true;
}

/// Columns of a file without a usable header, distinguished by their values.
std::vector<Column> columns_by_values(const TextRows& table, bool is_pts) {
    std::vector<Column> columns(table.columns, Column::other);
    const auto set = [&](std::size_t first, Column role) {
        for (std::size_t k = 0; k < 3; ++k) columns[first + k] = static_cast<Column>(static_cast<std::size_t>(role) + k);
    };
    set(0, Column::x);
    if (is_pts && table.columns == 7 && are_bytes(table, 4)) {
        columns[3] = Column::intensity;
        set(4, Column::red);
        return columns;
    }
    bool has_normals = false, has_colours = false, has_intensity = false;
    for (std::size_t c = 3; c < table.columns;) {
        const bool triple = c + 3 <= table.columns;
        if (triple && !has_normals && are_normals(table, c)) {
            set(c, Column::nx);
            has_normals = true;
            c += 3;
        } else if (triple && !has_colours && (are_bytes(table, c) || ((table.columns - c) % 3 == 0 && are_fractions(table, c)))) {
            set(c, Column::red);
            has_colours = true;
            c += 3;
        } else if (!has_intensity && (table.columns - c) % 3 != 0) {
            columns[c++] = Column::intensity;
            has_intensity = true;
        } else {
            ++c;
        }
    }
    return columns;
}

/// "columns 4 to 6 as colours, column 7 as intensity; column 8 is not kept".
std::string description(const std::vector<Column>& columns, const std::vector<std::string>& header) {
    std::vector<std::string> taken, unused;
    const auto from = [&](Column role, const char* name, std::size_t width) {
        const std::size_t first = column_index(columns, role);
        if (first == columns.size()) return;
        taken.push_back(width == 1 ? fmt::format("column {} as {}", first + 1, name)
                                   : fmt::format("columns {} to {} as {}", first + 1, first + width, name));
    };
    from(Column::nx, "normals", 3);
    from(Column::red, "colours", 3);
    from(Column::packed_colour, "packed colours", 1);
    from(Column::intensity, "intensity", 1);
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (columns[c] == Column::other) unused.push_back(header.empty() ? std::to_string(c + 1) : printable(header[c], 40));
    if (taken.empty() && unused.empty()) return {};
    std::string text =
        taken.empty() ? "only columns 1 to 3 were read" : joined(taken) + (header.empty() ? " (by their values)" : "");
    if (!unused.empty()) text += fmt::format("; not kept: column{} {}", unused.size() == 1 ? "" : "s", joined(unused));
    return text;
}

}  // namespace

PointCloud read_text_points(std::string_view bytes, const std::string& file, bool is_pts) {
    if (bytes.starts_with("[Expe/"))
        fail_input(file, "is a binary point set of Expe, which has the extension of PTS but other contents",
                   "open it in MeshLab and export it as PLY");
    if (bytes.find('\0') != std::string_view::npos)
        fail_input(file, "is not text: it has bytes of zero", "give a text file in UTF-8 with x y z a line");
    CloudLines lines(bytes, file);
    TextRows rows;
    read_rows(lines, is_pts, rows);
    CloudBuilder builder(file, bytes.size());
    if (rows.rows() == 0) return builder.finish();
    std::vector<Column> columns;
    if (names_coordinates(rows.header) && rows.header.size() == rows.columns) {
        for (const std::string& name : rows.header) columns.push_back(column_named(name));
    } else {
        if (!rows.header.empty())
            builder.note(
                rows.header.size() == rows.columns
                    ? "the header does not name x, y and z: the columns were distinguished by their values"
                    : fmt::format("the header names {} columns, the lines have {}: the columns were distinguished by their "
                                  "values",
                                  rows.header.size(), rows.columns));
        rows.header.clear();
        columns = columns_by_values(rows, is_pts);
    }
    if (rows.decimal_comma) builder.note("commas were read as decimal points, semicolons as separators");
    if (const std::string text = description(columns, rows.header); !text.empty()) builder.note(text);
    if (rows.stated_count >= 0 && rows.stated_count != static_cast<double>(rows.rows()))
        builder.note(fmt::format("the file states {:.0f} points and has {}", rows.stated_count, rows.rows()));
    CloudTable table;
    table.columns = std::move(columns);
    table.rows = rows.rows();
    table.at = [&rows](std::size_t row, std::size_t column) { return rows.at(row, column); };
    add_table(builder, table);
    return builder.finish();
}

}  // namespace ostraka::clouds
