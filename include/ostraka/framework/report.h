// The report of an operation. The operation fills it once; it can be written as a table, JSON, CSV or Markdown.
#pragma once

#include "ostraka/core/finding.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/provenance.h"

#include <concepts>
#include <deque>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ostraka {

class TextTable;

/// Type of a report field. `any` is a JSON structure, shown to programs only.
enum class FieldType { boolean, integer, number, text, numbers, texts, any };

/// Declares a value of a report, or a column of one of its tables.
struct Field {
    std::string key;                   ///< JSON key ('.' separates nested members); empty: the field is shown in texts only
    FieldType type = FieldType::text;  ///< type of the values
    std::string title = {};            ///< title in texts; empty: the field is in the JSON only
    std::string unit = {};  ///< unit of the values; "length", "length^2", ... are replaced by the unit of Report::set_unit
};

/// Helpers to declare fields: `report.table("parts", integer("id", "id"), number("area", "area", "length^2"))`.
namespace fields {
inline Field boolean(std::string key, std::string title = {}) { return {std::move(key), FieldType::boolean, std::move(title)}; }
inline Field integer(std::string key, std::string title = {}, std::string unit = {}) {
    return {std::move(key), FieldType::integer, std::move(title), std::move(unit)};
}
inline Field number(std::string key, std::string title = {}, std::string unit = {}) {
    return {std::move(key), FieldType::number, std::move(title), std::move(unit)};
}
inline Field text(std::string key, std::string title = {}) { return {std::move(key), FieldType::text, std::move(title)}; }
inline Field numbers(std::string key, std::string title = {}, std::string unit = {}) {
    return {std::move(key), FieldType::numbers, std::move(title), std::move(unit)};
}
inline Field texts(std::string key, std::string title = {}) { return {std::move(key), FieldType::texts, std::move(title)}; }
inline Field any(std::string key, std::string title = {}, std::string unit = {}) {
    return {std::move(key), FieldType::any, std::move(title), std::move(unit)};
}
/// A column that is shown in texts only, not in the JSON; an empty cell of a number column is shown as "-".
inline Field text_only(std::string title, FieldType type = FieldType::text, std::string unit = {}) {
    return {{}, type, std::move(title), std::move(unit)};
}
}  // namespace fields

/// The layout of a report, declared with the operation: single values and tables.
struct ReportLayout {
    std::vector<Field> value_fields;  ///< the single values
    struct Table {
        std::string key;  ///< JSON key of the array of rows; empty: the table is shown in texts only
        std::vector<Field> columns;
        std::string title = {};  ///< heading line in texts; empty: none
    };
    std::deque<Table> tables;  ///< the declared tables
    /// Name of the JSON schema (doc/schema) of the whole result; empty: only declared fields are allowed.
    std::string schema;
    bool checks = false;  ///< true: the operation calls Report::findings

    /// Declares single values.
    template <std::same_as<Field>... Columns>
    void values(Columns... columns) {
        (value_fields.push_back(std::move(columns)), ...);
    }
    template <std::same_as<Field>... Columns>
    void table(std::string key, Columns... columns) {
        table(std::move(key), std::vector<Field>{std::move(columns)...});
    }
    /// Declares a table.
    void table(std::string key, std::vector<Field> columns) { tables.push_back({std::move(key), std::move(columns)}); }
    /// Declares a table that is shown in texts only; `title` is also the name of the table in calls of Report::row.
    void text_table(std::string title, std::initializer_list<const char*> columns) {
        tables.push_back({{}, {}, std::move(title)});
        for (const char* column : columns) tables.back().columns.push_back(fields::text_only(column));
    }

    /// JSON schema (draft 4) of the member "result" of a report.
    [[nodiscard]] JsonValue to_schema(JsonAllocator& allocator) const;
};

/// Text of a cell; numbers are written with five significant digits.
struct ReportText {
    // NOLINTBEGIN(google-explicit-constructor): any of these is meant to be handed over as it is
    ReportText(std::string value) : text(std::move(value)) {}
    ReportText(const char* value) : text(value) {}
    ReportText(double value);
    template <std::integral Number>
    ReportText(Number value) : text(std::to_string(value)) {}
    // NOLINTEND(google-explicit-constructor)
    std::string text;
};

/// A value of a report. The value is absent if it is a number that is not finite or an empty optional.
class ReportValue {
public:
    // NOLINTBEGIN(google-explicit-constructor): any of these is meant to be handed over as it is
    ReportValue(bool value) : value_(value) {}
    ReportValue(double value);
    ReportValue(std::string value) : value_(std::move(value)) {}
    ReportValue(const char* value) : value_(std::string(value)) {}
    ReportValue(std::vector<double> values) : value_(std::move(values)) {}
    ReportValue(std::vector<std::string> values) : value_(std::move(values)) {}
    ReportValue(JsonValue value) : value_(std::move(value)) {}
    template <std::integral Number>
    ReportValue(Number value) : value_(static_cast<std::int64_t>(value)) {}
    template <std::integral Number>
    ReportValue(const std::vector<Number>& values) : value_(std::vector<std::int64_t>(values.begin(), values.end())) {}
    template <class Value>
    ReportValue(const std::optional<Value>& value) {
        if (value) *this = ReportValue(*value);
    }
    // NOLINTEND(google-explicit-constructor)

    /// True if there is no value.
    [[nodiscard]] bool absent() const { return std::holds_alternative<std::monostate>(value_); }
    /// The value as text; empty for JSON structures.
    [[nodiscard]] std::string text() const;
    /// The value as JSON for programs; may be called once.
    JsonValue json(JsonAllocator& allocator);

private:
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::int64_t>,
                 std::vector<std::string>, JsonValue>
        value_;
};

/// Output format of a report.
enum class ReportFormat { table, json, csv, markdown };

/// The report of one call: values, tables, notes and the answer.
class Report {
public:
    Report(Provenance provenance, ReportLayout layout);

    // ---- filled in by operations; undeclared keys throw std::logic_error ----

    /// Sets the unit of length shown in column titles.
    void set_unit(const std::string& unit) { unit_ = unit; }

    /// Sets the value of a declared field; `shown`: text that is shown, if different from the default text of the value.
    Report& operator()(std::string_view key, ReportValue value, std::optional<std::string> shown = {});
    /// Sets the values of all members of `object`, which follows the schema of the report.
    void values(const JsonValue& object);

    /// A row of a table, filled cell by cell. Cells that are absent or not filled are omitted from the JSON.
    class Row {
    public:
        /// Sets the cell of a column; `shown`: text that is shown, if different from the default text.
        Row& operator()(std::string_view key, ReportValue value, std::optional<std::string> shown = {});
        /// Sets the text that is shown in a cell. The column is given by its title (columns of texts only) or by
        /// its key (if the value is absent).
        Row& shown(std::string_view title_or_key, ReportText text);

    private:
        friend class Report;
        Row(Report& report, std::size_t table, std::size_t row) : report_(report), table_(table), row_(row) {}
        Report& report_;
        std::size_t table_, row_;
    };
    Row row(const std::string& table);  ///< adds an empty row to a table
    /// Adds a complete row, one cell per column, to a table that is shown in texts only (not in the JSON).
    void row(const std::string& table, std::initializer_list<ReportText> cells);
    /// Adds a table that has no rows; `shown`: true if texts show its header.
    void empty_table(const std::string& table, bool shown = true);

    /// Adds a value that is shown in texts only (not in the JSON), below the previous values.
    void text_only(const std::string& title, const std::string& text);
    /// Adds a table for texts only, which the operation also writes to files.
    void table(const TextTable& table);
    /// Adds a line of text; values, tables and lines are shown in the order in which they were added.
    void line(std::string text);
    /// Adds a note to the result; notes are printed on standard error and are in the JSON as result.notes.
    void note(std::string text);
    void notes(const std::vector<std::string>& texts);
    /// Sets the result of a check: result.sound, defects and findings. If there is a defect, the answer is "no". `place`: key and
    /// heading of the column of locations.
    void findings(const std::vector<Finding>& findings, const std::string& place = "where");
    /// Sets a value that may differ between identical runs, such as seconds; '.' in the key separates nested members.
    void run(const std::string& key, double value);
    /// Sets the answer to "no": a check found defects, a fragment was rejected, ...
    void answer_no() { holds_ = false; }

    /// Allocator for JSON structures.
    JsonAllocator& allocator() { return result_.GetAllocator(); }

    // ---- used by callers of operations ----

    [[nodiscard]] bool holds() const { return holds_; }                             ///< false after answer_no()
    [[nodiscard]] const JsonValue& result() const { return result_; }               ///< the values and tables as JSON
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }  ///< notes added so far
    [[nodiscard]] const ReportLayout& layout() const { return layout_; }
    [[nodiscard]] const Provenance& provenance() const { return provenance_; }
    void set_provenance(Provenance provenance) { provenance_ = std::move(provenance); }
    /// Called with each note when the note is added.
    std::function<void(const std::string&)> on_note;

    /// The report as JSON: {"format": "ostraka-report", "command", "result", "provenance", "run"}.
    [[nodiscard]] Json to_json() const;
    [[nodiscard]] std::string to_text(ReportFormat format) const;  ///< the report in the given format
    /// Durations of the run as text: "read 0.1 s, triangulate 0.05 s"; empty if there are none.
    [[nodiscard]] std::string times() const;

private:
    struct ShownTable {
        std::size_t layout = 0;
        /// Key -> index of the column; -1 for columns that only programs see.
        std::map<std::string, int, std::less<>> places;
        /// Key (or title of a column of texts only) -> index of the column in texts.
        std::map<std::string, int, std::less<>> shown;
        std::vector<std::string> empty;  ///< texts of the cells of a row before it is filled
        std::vector<std::vector<std::string>> rows;
    };
    /// A block of text: a line, a value (title and text), or a table.
    struct Block {
        enum class Kind { line, value, table, text_table } kind = Kind::line;
        std::string title, text;
        std::size_t table = 0;
        std::shared_ptr<const TextTable> text_table = {};
    };
    friend class Row;
    ShownTable& table_of(const std::string& key);
    [[nodiscard]] std::string in_unit(const Field& field) const;
    [[nodiscard]] std::string shown_table(const ShownTable& table, ReportFormat format) const;

    Provenance provenance_;
    ReportLayout layout_;
    Json result_, run_;
    std::string unit_;
    std::vector<Block> blocks_;
    std::deque<ShownTable> tables_;
    std::map<std::string, std::size_t> table_index_;
    std::vector<std::string> notes_;
    bool holds_ = true;
};

/// A number as text, with `digits` significant digits.
std::string number(double value, int digits = 5);

}  // namespace ostraka
