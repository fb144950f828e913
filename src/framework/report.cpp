#include "ostraka/framework/report.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/figures/markdown.h"
#include "ostraka/figures/table.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace ostraka {

namespace {

/// Sets a nested member ("distortion.A"), creating the objects in between.
void set_member(JsonValue& object, std::string_view key, JsonValue value, JsonAllocator& allocator) {
    JsonValue* parent = &object;
    for (std::size_t dot; (dot = key.find('.')) != std::string_view::npos; key.remove_prefix(dot + 1)) {
        const std::string_view name = key.substr(0, dot);
        if (find_member(*parent, name) == nullptr) add_member(*parent, name, JsonValue(rapidjson::kObjectType), allocator);
        parent = const_cast<JsonValue*>(find_member(*parent, name));
    }
    if (const JsonValue* existing = find_member(*parent, key)) *const_cast<JsonValue*>(existing) = std::move(value);
    else add_member(*parent, key, std::move(value), allocator);
}

bool is_number(const std::string& text) {
    return !text.empty() && (std::isdigit(static_cast<unsigned char>(text.front())) != 0 || text.front() == '-') &&
           text.find_first_of("0123456789") != std::string::npos;
}

const Field* find_field(const std::vector<Field>& fields, std::string_view key) {
    const auto match = std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.key == key; });
    return match == fields.end() ? nullptr : &*match;
}

/// A table for terminals: padded columns, numbers right-aligned, no text truncated.
std::string plain_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::vector<std::string>> table_rows{header};
    for (const auto& row : rows) {
        table_rows.push_back(row);
        table_rows.back().resize(header.size());
        for (auto& cell : table_rows.back()) cell = printable(cell, std::string::npos);
    }
    const auto is_numeric = [](const std::string& cell) { return cell.empty() || cell == "-" || is_number(cell); };
    return aligned_rows(table_rows, [&](std::size_t row, std::size_t column) {
        if (row > 0) return is_number(table_rows[row][column]);
        return table_rows.size() > 1 && std::all_of(table_rows.begin() + 1, table_rows.end(),
                                                    [&](const auto& cells) { return is_numeric(cells[column]); });
    });
}

/// Names and values, one pair per line, with the values aligned.
std::string plain_values(const std::vector<std::pair<std::string, std::string>>& rows) {
    std::size_t width = 0;
    for (const auto& [name, value] : rows) width = std::max(width, shown_width(name));
    std::string text;
    for (const auto& [name, value] : rows)
        text += name + std::string(width - shown_width(name) + 2, ' ') + printable(value, std::string::npos) + "\n";
    return text;
}

}  // namespace

ReportText::ReportText(double value) : text(number(value)) {}

ReportValue::ReportValue(double value) {
    if (std::isfinite(value)) value_ = value;
}

std::string ReportValue::text() const {
    return std::visit(
        [](const auto& value) -> std::string {
            using Type = std::remove_cvref_t<decltype(value)>;
            if constexpr (std::same_as<Type, bool>) return value ? "yes" : "no";
            else if constexpr (std::is_arithmetic_v<Type> || std::same_as<Type, std::string>) return ReportText(value).text;
            else if constexpr (std::same_as<Type, std::vector<std::string>>) return joined(value);
            else if constexpr (requires { value.begin(); })
                return joined(value, " ", [](auto item) { return ReportText(item).text; });
            else return {};
        },
        value_);
}

JsonValue ReportValue::json(JsonAllocator& allocator) {
    return std::visit(
        [&](auto& value) {
            if constexpr (std::same_as<std::remove_cvref_t<decltype(value)>, std::monostate>) return JsonValue();
            else return json_value(std::move(value), allocator);
        },
        value_);
}

Report::Report(Provenance provenance, ReportLayout layout) : provenance_(std::move(provenance)), layout_(std::move(layout)) {
    result_.SetObject();
    run_.SetObject();
}

Report& Report::operator()(std::string_view key, ReportValue value, std::optional<std::string> shown) {
    const Field* field = find_field(layout_.value_fields, key);
    if (field == nullptr && layout_.schema.empty()) throw std::logic_error(fmt::format("the report declares no value '{}'", key));
    if (value.absent()) return *this;
    if (field != nullptr && !field->title.empty())
        text_only(field->title, (shown ? *shown : value.text()) + (in_unit(*field).empty() ? "" : " " + in_unit(*field)));
    set_member(result_, key, value.json(allocator()), allocator());
    return *this;
}

void Report::values(const JsonValue& object) {
    for (const auto& member : object.GetObject()) (*this)(member.name.GetString(), JsonValue(member.value, allocator()));
}

Report::ShownTable& Report::table_of(const std::string& key) {
    if (const auto shown = table_index_.find(key); shown != table_index_.end()) return tables_[shown->second];
    const auto layout = std::find_if(layout_.tables.begin(), layout_.tables.end(), [&](const auto& table) {
        return table.key.empty() ? table.title == key : table.key == key;
    });
    if (layout == layout_.tables.end()) throw std::logic_error(fmt::format("the report declares no table '{}'", key));
    table_index_[key] = tables_.size();
    blocks_.push_back({Block::Kind::table, {}, {}, tables_.size()});
    if (!layout->key.empty()) set_member(result_, key, JsonValue(rapidjson::kArrayType), allocator());
    ShownTable& table =
        tables_.emplace_back(ShownTable{static_cast<std::size_t>(layout - layout_.tables.begin()), {}, {}, {}, {}});
    for (const Field& column : layout->columns) {
        const int place = column.title.empty() ? -1 : static_cast<int>(table.empty.size());
        if (!column.key.empty()) table.places.emplace(column.key, place);
        if (place < 0) continue;
        table.shown.emplace(column.key.empty() ? column.title : column.key, place);
        table.empty.emplace_back(column.type == FieldType::number ? "-" : "");
    }
    return table;
}

void Report::empty_table(const std::string& table, bool shown) {
    if (shown) table_of(table);
    else set_member(result_, table, JsonValue(rapidjson::kArrayType), allocator());
}

Report::Row Report::row(const std::string& table) {
    ShownTable& shown = table_of(table);
    shown.rows.push_back(shown.empty);
    if (const std::string& key = layout_.tables[shown.layout].key; !key.empty())
        const_cast<JsonValue*>(find_member(result_, key))->PushBack(JsonValue(rapidjson::kObjectType), allocator());
    return {*this, table_index_.at(table), shown.rows.size() - 1};
}

void Report::row(const std::string& table, std::initializer_list<ReportText> cells) {
    ShownTable& shown = table_of(table);
    if (cells.size() != shown.empty.size())
        throw std::logic_error(fmt::format("a row of the table '{}' has other columns", table));
    auto& row = shown.rows.emplace_back();
    for (const ReportText& cell : cells) row.push_back(cell.text);
}

Report::Row& Report::Row::operator()(std::string_view key, ReportValue value, std::optional<std::string> text) {
    ShownTable& table = report_.tables_[table_];
    const std::string& table_key = report_.layout_.tables[table.layout].key;
    const auto column = table.places.find(key);
    if (column == table.places.end() || table_key.empty())
        throw std::logic_error(fmt::format("table '{}' of the report declares no column '{}'", table_key, key));
    if (value.absent()) return *this;
    if (column->second >= 0) table.rows[row_][static_cast<std::size_t>(column->second)] = text ? std::move(*text) : value.text();
    JsonValue& rows = *const_cast<JsonValue*>(find_member(report_.result_, table_key));
    set_member(rows[static_cast<rapidjson::SizeType>(row_)], key, value.json(report_.allocator()), report_.allocator());
    return *this;
}

Report::Row& Report::Row::shown(std::string_view title_or_key, ReportText text) {
    ShownTable& table = report_.tables_[table_];
    const auto column = table.shown.find(title_or_key);
    if (column == table.shown.end())
        throw std::logic_error(fmt::format("the report's table has no column '{}' for people", title_or_key));
    table.rows[row_][static_cast<std::size_t>(column->second)] = std::move(text.text);
    return *this;
}

void Report::text_only(const std::string& title, const std::string& text) {
    blocks_.push_back({Block::Kind::value, title, text, 0});
}

void Report::table(const TextTable& table) {
    blocks_.push_back({Block::Kind::text_table, {}, {}, 0, std::make_shared<const TextTable>(table)});
}

void Report::line(std::string text) { blocks_.push_back({Block::Kind::line, {}, std::move(text), 0}); }

void Report::note(std::string text) {
    if (on_note) on_note(text);
    notes_.push_back(std::move(text));
}
void Report::notes(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) note(text);
}

void Report::findings(const std::vector<Finding>& findings, const std::string& place) {
    if (!layout_.checks) throw std::logic_error("the report declares no findings");
    JsonValue list(rapidjson::kArrayType);
    std::size_t defects = 0;
    std::vector<std::vector<std::string>> rows;
    for (const Finding& finding : findings) {
        defects += finding.defect ? 1 : 0;
        const auto& row =
            rows.emplace_back(std::vector{std::string(finding.defect ? "defect" : "remark"), finding.where, finding.text});
        list.PushBack(json_object(allocator(), "kind", row[0], place, row[1], "text", row[2]), allocator());
    }
    add_members(result_, allocator(), "sound", defects == 0, "defects", defects, "findings", std::move(list));
    if (!rows.empty()) {
        std::string text = plain_table({"kind", place, "what"}, rows);
        text.pop_back();
        line(text);
    }
    line(defects == 0 ? "no defects" : counted(defects, "defect"));
    if (defects > 0) answer_no();
}

void Report::run(const std::string& key, double value) { set_member(run_, key, JsonValue(value), run_.GetAllocator()); }

Json Report::to_json() const {
    Json report(rapidjson::kObjectType);
    auto& allocator = report.GetAllocator();
    JsonValue result(result_, allocator);
    if (find_member(result, "notes") == nullptr) add_members(result, allocator, "notes", notes_);
    add_members(report, allocator, "format", "ostraka-report", "command", provenance_.command, "result", std::move(result),
                "provenance", provenance_.to_json(allocator));
    if (run_.MemberCount() > 0) add_members(report, allocator, "run", run_);
    return report;
}

std::string Report::times() const {
    std::string text;
    const std::function<void(const JsonValue&)> add = [&](const JsonValue& object) {
        for (const auto& member : object.GetObject())
            if (member.value.IsObject()) add(member.value);
            else if (const std::string name = member.name.GetString(); name != "threads")
                text += fmt::format("{}{}{} s", text.empty() ? "" : ", ", name == "seconds" ? "" : name + " ",
                                    number(member.value.GetDouble(), 3));
    };
    add(run_);
    return text;
}

std::string Report::in_unit(const Field& field) const {
    std::string text = field.unit;
    const std::size_t position = text.find("length");
    if (position == std::string::npos) return text;
    return unit_.empty() ? "" : text.replace(position, 6, printable(unit_, 20));
}

std::string Report::shown_table(const ShownTable& table, ReportFormat format) const {
    const auto& layout = layout_.tables[table.layout];
    std::vector<std::string> header;
    for (const Field& column : layout.columns)
        if (!column.title.empty()) header.push_back(column.title + (in_unit(column).empty() ? "" : " " + in_unit(column)));
    if (header.empty()) return {};
    if (format == ReportFormat::table) return (layout.title.empty() ? "" : layout.title + "\n") + plain_table(header, table.rows);
    TextTable text(header);
    for (const auto& row : table.rows) text.add(row);
    return format == ReportFormat::csv ? text.csv() : text.markdown();
}

std::string Report::to_text(ReportFormat format) const {
    if (format == ReportFormat::json) return ostraka::to_text(to_json());
    std::string text;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
        const Block& block = blocks_[i];
        if (block.kind == Block::Kind::line) {
            if (format == ReportFormat::markdown) text += markdown_paragraphs(block.text) + "\n";
            else if (format != ReportFormat::csv) text += block.text + "\n";
        } else if (block.kind == Block::Kind::table || block.kind == Block::Kind::text_table) {
            const TextTable* text_table = block.text_table.get();
            const std::string shown = text_table == nullptr           ? shown_table(tables_[block.table], format)
                                      : format == ReportFormat::table ? text_table->plain()
                                      : format == ReportFormat::csv   ? text_table->csv()
                                                                      : text_table->markdown();
            if (!text.empty() && !shown.empty() && format != ReportFormat::table) text += "\n";
            text += shown;
        } else {
            std::vector<std::pair<std::string, std::string>> rows;
            for (; i < blocks_.size() && blocks_[i].kind == Block::Kind::value; ++i)
                rows.emplace_back(blocks_[i].title, blocks_[i].text);
            --i;
            if (format == ReportFormat::table) {
                text += plain_values(rows);
                continue;
            }
            TextTable table(std::vector<std::string>{"what", "value"});
            for (const auto& [title, value] : rows) table.add(std::vector<std::string>{title, value});
            text += (text.empty() ? "" : "\n") + (format == ReportFormat::csv ? table.csv() : table.markdown());
        }
    }
    return text;
}

std::string number(double value, int digits) { return ostraka::digits(value, digits); }

}  // namespace ostraka
