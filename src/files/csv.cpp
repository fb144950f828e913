#include "ostraka/files/csv.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

bool is_blank(char32_t code) {
    return code == ' ' || code == '\t' || code == '\r' || code == '\n' || code == 0x85 || code == 0xA0 || code == 0x1680 ||
           (code >= 0x2000 && code <= 0x200D) || code == 0x2028 || code == 0x2029 || code == 0x202F || code == 0x205F ||
           code == 0x2060 || code == 0x3000 || code == 0xFEFF;
}

/// The characters that begin a formula, including their small, full-width and typographic forms.
bool is_formula_sign(char32_t code) {
    constexpr std::u32string_view signs = U"=+-@\u2212\uFE62\uFE63\uFE66\uFE6B\uFF0B\uFF0D\uFF1D\uFF20";
    return signs.find(code) != std::u32string_view::npos;
}

/// Whether a spreadsheet could see a formula: at the front or at a position where it may begin a new cell, after a semicolon, a
/// tab, a line break or a non-ASCII blank.
bool dangerous(std::string_view text) {
    if (text.empty()) return false;
    if (text.front() == '\t' || text.front() == '\r' || text.front() == '\n') return true;
    bool begins = true;
    for (std::size_t position = 0; position < text.size();) {
        const auto [code, length] = character_at(text, position);
        if (begins && is_formula_sign(code)) return true;
        begins = code == ';' || (is_blank(code) && (begins || code != ' '));
        position += length;
    }
    return false;
}

/// Whether `escape_formula` adds an apostrophe. Any number of apostrophes may precede the dangerous text, so that
/// `unescape_formula` is the inverse.
bool needs_guard(std::string_view text) {
    const std::size_t first = text.find_first_not_of('\'');
    return first != std::string_view::npos && dangerous(text.substr(first));
}

}  // namespace

std::string escape_formula(const std::string& text) { return needs_guard(text) ? "'" + text : text; }

std::string unescape_formula(const std::string& text) {
    return text.size() > 1 && text.front() == '\'' && needs_guard(std::string_view(text).substr(1)) ? text.substr(1) : text;
}

std::string csv_row(const std::vector<std::string>& cells) {
    std::string row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) row += ',';
        const std::string cell =
            number_of(cells[i]) && trimmed(cells[i]).size() == cells[i].size() ? cells[i] : escape_formula(cells[i]);
        const bool has_outer_blank = !cell.empty() && (cell.front() == ' ' || cell.back() == ' ');
        const bool quoted = has_outer_blank || cell.find_first_of(",;\"\r\n\t'") != std::string::npos;
        if (!quoted) {
            row += cell;
            continue;
        }
        row += '"';
        for (const char c : cell) row.append(c == '"' ? 2 : 1, c);
        row += '"';
    }
    return row + '\n';
}

namespace {

/// Reads the cells of a CSV text one by one (RFC 4180; lines may end with "\r\n" or "\n").
class CsvReader {
public:
    CsvReader(std::string_view text, char separator, const std::string& where)
        : text_(text), separator_(separator), where_(where) {}

    [[nodiscard]] bool at_end() const { return i_ == text_.size(); }

    /// The next row; `is_blank`: whether all its cells are unquoted blanks.
    CsvRow row(bool& is_blank) {
        CsvRow row{line_, {}};
        is_blank = true;
        for (bool more = true; more;) {
            if (sees('"')) {
                row.cells.push_back(quoted_cell());
                is_blank = false;
            } else {
                row.cells.push_back(plain_cell());
                is_blank = is_blank && trimmed(row.cells.back()).empty();
            }
            if (sees('\r')) ++i_;
            more = sees(separator_);
            if (more) ++i_;
        }
        if (sees('\n')) ++i_, ++line_;
        return row;
    }

private:
    [[nodiscard]] bool sees(char c) const { return i_ < text_.size() && text_[i_] == c; }

    std::string quoted_cell() {
        const std::string location = fmt::format("{}, line {}", where_, line_);
        std::string cell;
        for (++i_;; ++i_) {
            if (at_end()) fail_input(location, "a quoted cell does not end", "close its quotation mark");
            if (text_[i_] == '"') {
                ++i_;
                if (!sees('"')) break;
            }
            line_ += text_[i_] == '\n' ? 1 : 0;
            cell += text_[i_];
        }
        if (!at_end() && !sees(separator_) && !sees('\n') && !sees('\r'))
            fail_input(location, "text follows the closing quotation mark of a cell", "double the marks within the cell");
        return cell;
    }

    std::string plain_cell() {
        const std::size_t begin = i_;
        while (!at_end() && !sees(separator_) && !sees('\n')) ++i_;
        std::string cell(text_.substr(begin, i_ - begin));
        if (!sees(separator_) && !cell.empty() && cell.back() == '\r') cell.pop_back();
        return cell;
    }

    std::string_view text_;
    char separator_;
    const std::string& where_;
    std::size_t i_ = 0, line_ = 1;
};

}  // namespace

std::vector<CsvRow> csv_rows(std::string_view text, char separator, const std::string& where) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::vector<CsvRow> rows;
    for (CsvReader reader(text, separator, where); !reader.at_end();) {
        bool is_blank = true;
        CsvRow row = reader.row(is_blank);
        if (!is_blank) rows.push_back(std::move(row));
    }
    return rows;
}

char csv_separator(std::string_view text) {
    const std::string_view first = text.substr(0, text.find('\n'));
    char best = ',';
    for (const char c : {',', ';', '\t'})
        if (std::count(first.begin(), first.end(), c) > std::count(first.begin(), first.end(), best)) best = c;
    return best;
}

}  // namespace ostraka
