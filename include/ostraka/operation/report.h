// What an operation has to say: filled once, shown as a table, JSON, CSV or Markdown.
#pragma once

#include "ostraka/core/finding.h"
#include "ostraka/core/provenance.h"
#include "ostraka/core/words.h"

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

/// What a field of a report holds. `any` is a structure that only programs read.
enum class FieldType { boolean, integer, number, text, numbers, texts, any };

/// A value of a report, or a column of one of its tables.
struct Field {
    std::string key;  ///< in JSON, '.' for a member of a member; empty: for people only
    FieldType type = FieldType::text;
    std::string title = {};  ///< for people; empty: for programs only
    std::string unit = {};   ///< "length", "length^2", ... stand for the unit of the report (Report::set_unit)
};

/// How operations declare fields: `report.table("parts", integer("id", "id"), number("area", "area", "length^2"))`.
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
/// A column for people only; one of numbers shows "-" where there is none.
inline Field people(std::string title, FieldType type = FieldType::text, std::string unit = {}) {
    return {{}, type, std::move(title), std::move(unit)};
}
}  // namespace fields

/// The layout of a report, declared with the operation: its values, and tables of rows.
struct ReportLayout {
    std::vector<Field> of_values;
    struct Table {
        std::string key;  ///< an array of objects in JSON; empty: for people only
        std::vector<Field> columns;
        std::string title = {};  ///< a line above it, for people
    };
    std::deque<Table> tables;
    std::string schema;   ///< name of a schema (doc/schema) that the whole result keeps; empty: only what is declared
    bool checks = false;  ///< Report::findings is called

    template <std::same_as<Field>... Columns>
    void values(Columns... columns) {
        (of_values.push_back(std::move(columns)), ...);
    }
    template <std::same_as<Field>... Columns>
    void table(std::string key, Columns... columns) {
        table(std::move(key), std::vector<Field>{std::move(columns)...});
    }
    void table(std::string key, std::vector<Field> columns) { tables.push_back({std::move(key), std::move(columns)}); }
    /// For people only; rows are filled under its title.
    void people_table(std::string title, std::initializer_list<const char*> columns) {
        tables.push_back({{}, {}, std::move(title)});
        for (const char* column : columns) tables.back().columns.push_back(fields::people(column));
    }

    /// JSON schema (draft 4) of the member "result" of a report.
    [[nodiscard]] JsonValue to_schema(JsonAllocator& allocator) const;
};

/// What people read: text, or a number as numbers usually are (five significant digits).
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

/// A value of a report. Numbers that are not finite, and what is optional and not there, are absent.
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

    [[nodiscard]] bool absent() const { return std::holds_alternative<std::monostate>(value_); }
    /// As people read it; empty for structures.
    [[nodiscard]] std::string text() const;
    /// As programs read it; may be called once.
    JsonValue json(JsonAllocator& allocator);

private:
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::int64_t>,
                 std::vector<std::string>, JsonValue>
        value_;
};

/// How a report is shown.
enum class ReportFormat { table, json, csv, markdown };

class Report {
public:
    Report(Provenance provenance, ReportLayout layout);

    // ---- what an operation fills in; keys that were not declared throw std::logic_error ----

    /// Unit of length of the objects at hand, which the titles of columns show.
    void set_unit(const std::string& unit) { unit_ = unit; }

    /// A value; `shown`: how people read it, where not as usual.
    Report& operator()(std::string_view key, ReportValue value, std::optional<std::string> shown = {});
    /// All members of an object that keeps the schema of the report.
    void values(const JsonValue& object);

    /// A row of a table, filled cell by cell. Cells that are absent or not filled are left out.
    class Row {
    public:
        Row& operator()(std::string_view key, ReportValue value, std::optional<std::string> shown = {});
        /// The cell of a column for people only, named by its title; or what people read of a cell that is absent.
        Row& shown(std::string_view title_or_key, ReportText text);

    private:
        friend class Report;
        Row(Report& report, std::size_t table, std::size_t row) : report_(report), table_(table), row_(row) {}
        Report& report_;
        std::size_t table_, row_;
    };
    Row row(const std::string& table);
    /// A row of a table for people only: a cell a column.
    void row(const std::string& table, std::initializer_list<ReportText> cells);
    /// A table that is there although it has no rows; `shown`: people see its header.
    void empty_table(const std::string& table, bool shown = true);

    /// A value for people only, below those before it.
    void people(const std::string& title, const std::string& text);
    /// A table for people that is written to files as well, as it stands there.
    void table(const TextTable& table);
    /// A line for people among the values and tables, in the order of the calls.
    void line(std::string text);
    /// What a user should know beside the result: on standard error, and in JSON as result.notes.
    void note(std::string text);
    void notes(const std::vector<std::string>& texts);
    /// Results of a check: result.sound, defects and findings. A defect means that the answer is no. `place`: what the places of
    /// the findings are called.
    void findings(const std::vector<Finding>& findings, const std::string& place = "where");
    /// What may differ between two runs of the same work, such as seconds; '.' in the key as in fields.
    void run(const std::string& key, double value);
    /// The answer is "no": a check that found defects, a fragment that is refused.
    void answer_no() { holds_ = false; }

    /// For structures.
    JsonAllocator& allocator() { return result_.GetAllocator(); }

    // ---- what others do with it ----

    [[nodiscard]] bool holds() const { return holds_; }
    [[nodiscard]] const JsonValue& result() const { return result_; }
    [[nodiscard]] const std::vector<std::string>& noted() const { return notes_; }
    [[nodiscard]] const ReportLayout& layout() const { return layout_; }
    [[nodiscard]] const Provenance& provenance() const { return provenance_; }
    void set_provenance(Provenance provenance) { provenance_ = std::move(provenance); }
    /// Called with each note as it is made.
    std::function<void(const std::string&)> on_note;

    /// {"format": "ostraka-report", "command", "result", "provenance", "run"}.
    [[nodiscard]] Json to_json() const;
    [[nodiscard]] std::string to_text(ReportFormat format) const;
    /// The seconds of the run, for people: "read 0.1 s, triangulate 0.05 s"; empty where there are none.
    [[nodiscard]] std::string times() const;

private:
    struct ShownTable {
        std::size_t layout = 0;
        std::map<std::string, int, std::less<>> places;  ///< of keys in the rows, -1 of what only programs read
        std::map<std::string, int, std::less<>> shown;   ///< of keys, or titles for people only
        std::vector<std::string> empty;                  ///< a row without values
        std::vector<std::vector<std::string>> rows;
    };
    /// What people see, in order: a line, a value (title and text), or a table.
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

/// A number for people: so many significant digits.
std::string number(double value, int digits = 5);

}  // namespace ostraka
