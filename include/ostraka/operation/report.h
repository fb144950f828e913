// What an operation has to say: filled once, shown as a table, JSON, CSV or Markdown.
#pragma once

#include "ostraka/core/finding.h"
#include "ostraka/core/provenance.h"

#include <concepts>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

class TextTable;

/// What a field of a report holds. `any` is a structure that only programs read.
enum class FieldType { boolean, integer, number, text, numbers, texts, any };

/// A value of a report, or a column of one of its tables.
struct Field {
    std::string key;  ///< in JSON, '.' for a member of a member; empty: for people only
    FieldType type = FieldType::text;
    std::string title = {};   ///< for people; empty: for programs only
    std::string unit = {};    ///< "length", "length^2", ... stand for the unit of the report (Report::set_unit)
    std::string schema = {};  ///< of type any: name of a schema (doc/schema) that the structure keeps
};

/// The layout of a report, declared with the operation.
struct ReportLayout {
    std::vector<Field> values;
    struct Table {
        std::string key;  ///< an array of objects in JSON; empty: for people only
        std::vector<Field> columns;
        std::string title;  ///< a line above it, for people
    };
    std::deque<Table> tables;
    std::string schema;   ///< name of a schema (doc/schema) that the whole result keeps; empty: only what is declared
    bool checks = false;  ///< Report::findings is called

    ReportLayout& value(std::string key, FieldType type, std::string title = {}, std::string unit = {});
    /// A structure that only programs read; `schema`: that of a file format it keeps.
    ReportLayout& structure(std::string key, std::string schema = {});
    ReportLayout& table(std::string key, std::vector<Field> columns, std::string title = {});

    /// JSON schema (draft 4) of the member "result" of a report.
    [[nodiscard]] JsonValue to_schema(JsonAllocator& allocator) const;
};

/// How a report is shown.
enum class ReportFormat { table, json, csv, markdown };

class Report {
public:
    Report(Provenance provenance, ReportLayout layout);

    // ---- what an operation fills in; keys that were not declared throw std::logic_error ----

    /// Unit of length of the objects at hand, which the titles of columns show.
    void set_unit(const std::string& unit) { unit_ = unit; }

    /// A value; `shown`: how people read it, where not as numbers usually are (five significant digits).
    void value(const std::string& key, bool value, std::optional<std::string> shown = {});
    void value(const std::string& key, double value, std::optional<std::string> shown = {});
    void value(const std::string& key, const std::string& value, std::optional<std::string> shown = {});
    void value(const std::string& key, const char* value) { this->value(key, std::string(value)); }
    void value(const std::string& key, const std::vector<double>& value, std::optional<std::string> shown = {});
    void value(const std::string& key, const std::vector<std::string>& value, std::optional<std::string> shown = {});
    void value(const std::string& key, JsonValue value);
    /// All members of an object that keeps the schema of the report.
    void values(const JsonValue& object);
    template <std::integral Number>
    requires(!std::same_as<Number, bool>) void value(const std::string& key, Number value,
                                                     std::optional<std::string> shown = {}) {
        integer(key, static_cast<std::int64_t>(value), std::move(shown));
    }

    /// A row of a table, filled cell by cell. Numbers that are not finite, and cells that are not filled, are absent.
    class Row {
    public:
        Row& operator()(const std::string& key, bool value, std::optional<std::string> shown = {});
        Row& operator()(const std::string& key, double value, std::optional<std::string> shown = {});
        Row& operator()(const std::string& key, const std::string& value, std::optional<std::string> shown = {});
        Row& operator()(const std::string& key, const char* value) { return (*this)(key, std::string(value)); }
        Row& operator()(const std::string& key, const std::vector<double>& value, std::optional<std::string> shown = {});
        Row& operator()(const std::string& key, const std::vector<std::string>& value, std::optional<std::string> shown = {});
        Row& operator()(const std::string& key, JsonValue value);
        template <std::integral Number>
        requires(!std::same_as<Number, bool>) Row& operator()(const std::string& key, Number value,
                                                              std::optional<std::string> shown = {}) {
            return integer(key, static_cast<std::int64_t>(value), std::move(shown));
        }
        /// The cell of a column for people only, named by its title; or what people read of a cell that is absent.
        Row& shown(const std::string& title_or_key, const std::string& text);

    private:
        friend class Report;
        Row(Report& report, std::size_t table, std::size_t row) : report_(report), table_(table), row_(row) {}
        Row& integer(const std::string& key, std::int64_t value, std::optional<std::string> shown);
        Row& put(const std::string& key, JsonValue value, std::string text);
        Report& report_;
        std::size_t table_, row_;
    };
    Row row(const std::string& table);
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
    void integer(const std::string& key, std::int64_t value, std::optional<std::string> shown);
    void put(const std::string& key, JsonValue value, std::string text);
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

/// A table for terminals: columns padded, numbers right-aligned, no text cut.
std::string plain_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
/// Names and values, one a line, the values below each other.
std::string plain_values(const std::vector<std::pair<std::string, std::string>>& rows);
/// A number for people: so many significant digits.
std::string number(double value, int digits = 5);
/// Text of files is data: no control character reaches a terminal, at most so many columns.
std::string printable(const std::string& text, std::size_t most = 10000);

}  // namespace ostraka
