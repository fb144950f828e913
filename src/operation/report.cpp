#include "ostraka/operation/report.h"

#include "ostraka/core/text.h"
#include "ostraka/report/table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace ostraka {

namespace {

/// Sets a member of a member ("distortion.A"), making what is between.
void set_member(JsonValue& object, std::string_view key, JsonValue value, JsonAllocator& allocator) {
    JsonValue* at = &object;
    for (std::size_t dot; (dot = key.find('.')) != std::string_view::npos; key.remove_prefix(dot + 1)) {
        const std::string_view name = key.substr(0, dot);
        if (find_member(*at, name) == nullptr) add_member(*at, name, JsonValue(rapidjson::kObjectType), allocator);
        at = const_cast<JsonValue*>(find_member(*at, name));
    }
    if (const JsonValue* known = find_member(*at, key)) *const_cast<JsonValue*>(known) = std::move(value);
    else add_member(*at, key, std::move(value), allocator);
}

JsonValue type_schema(const Field& field, JsonAllocator& allocator) {
    JsonValue schema(rapidjson::kObjectType);
    const auto array_of = [&](const char* type) {
        JsonValue items(rapidjson::kObjectType);
        add_member(items, "type", type, allocator);
        add_member(schema, "type", "array", allocator);
        add_member(schema, "items", std::move(items), allocator);
    };
    switch (field.type) {
        case FieldType::boolean:
            add_member(schema, "type", "boolean", allocator);
            break;
        case FieldType::integer:
            add_member(schema, "type", "integer", allocator);
            break;
        case FieldType::number:
            add_member(schema, "type", "number", allocator);
            break;
        case FieldType::text:
            add_member(schema, "type", "string", allocator);
            break;
        case FieldType::numbers:
            array_of("number");
            break;
        case FieldType::texts:
            array_of("string");
            break;
        case FieldType::any:
            break;
    }
    std::string about = field.title;
    if (!field.unit.empty()) about += (about.empty() ? "in " : ", in ") + field.unit;
    if (!field.schema.empty()) about += (about.empty() ? "as " : "; as ") + field.schema + ".schema.json has it";
    if (!about.empty()) add_member(schema, "description", about, allocator);
    return schema;
}

/// The object with these fields, as a schema; dots in keys are members of members.
JsonValue object_schema(const std::vector<Field>& fields, JsonAllocator& allocator) {
    JsonValue schema(rapidjson::kObjectType), properties(rapidjson::kObjectType);
    add_member(schema, "type", "object", allocator);
    std::map<std::string, std::vector<Field>> inner;
    std::vector<std::string> order;
    for (const Field& field : fields) {
        if (field.key.empty()) continue;
        const std::size_t dot = field.key.find('.');
        const std::string name = field.key.substr(0, dot);
        if (inner.find(name) == inner.end()) order.push_back(name);
        Field rest = field;
        rest.key = dot == std::string::npos ? "" : field.key.substr(dot + 1);
        inner[name].push_back(std::move(rest));
    }
    for (const std::string& name : order) {
        const auto& list = inner.at(name);
        add_member(properties, name,
                   list.front().key.empty() ? type_schema(list.front(), allocator) : object_schema(list, allocator), allocator);
    }
    add_member(schema, "properties", std::move(properties), allocator);
    add_member(schema, "additionalProperties", JsonValue(false), allocator);
    return schema;
}

bool is_number(const std::string& text) {
    return !text.empty() && (std::isdigit(static_cast<unsigned char>(text.front())) != 0 || text.front() == '-') &&
           text.find_first_of("0123456789") != std::string::npos;
}

JsonValue list_of(const std::vector<double>& values, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const double one : values) list.PushBack(one, allocator);
    return list;
}
JsonValue list_of(const std::vector<std::string>& values, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const std::string& one : values) list.PushBack(json_string(one, allocator), allocator);
    return list;
}
std::string text_of(const std::vector<double>& values) {
    std::string text;
    for (const double one : values) text += (text.empty() ? "" : " ") + number(one);
    return text;
}
std::string text_of(const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& one : values) text += (text.empty() ? "" : ", ") + one;
    return text;
}

const Field* find_field(const std::vector<Field>& fields, const std::string& key) {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.key == key; });
    return found == fields.end() ? nullptr : &*found;
}

}  // namespace

ReportLayout& ReportLayout::value(std::string key, FieldType type, std::string title, std::string unit) {
    values.push_back({std::move(key), type, std::move(title), std::move(unit)});
    return *this;
}

ReportLayout& ReportLayout::structure(std::string key, std::string of_schema) {
    values.push_back({std::move(key), FieldType::any, {}, {}, std::move(of_schema)});
    return *this;
}

ReportLayout& ReportLayout::table(std::string key, std::vector<Field> columns, std::string title) {
    tables.push_back({std::move(key), std::move(columns), std::move(title)});
    return *this;
}

JsonValue ReportLayout::to_schema(JsonAllocator& allocator) const {
    JsonValue result = object_schema(values, allocator);
    JsonValue* properties = const_cast<JsonValue*>(find_member(result, "properties"));
    for (const Table& table : tables) {
        if (table.key.empty()) continue;
        JsonValue list(rapidjson::kObjectType);
        add_member(list, "type", "array", allocator);
        if (!table.title.empty()) add_member(list, "description", table.title, allocator);
        add_member(list, "items", object_schema(table.columns, allocator), allocator);
        add_member(*properties, table.key, std::move(list), allocator);
    }
    if (checks) {
        add_member(*properties, "sound", type_schema({"sound", FieldType::boolean}, allocator), allocator);
        add_member(*properties, "defects", type_schema({"defects", FieldType::integer}, allocator), allocator);
        add_member(*properties, "findings", type_schema({"findings", FieldType::any}, allocator), allocator);
    }
    add_member(*properties, "notes", type_schema({"notes", FieldType::texts}, allocator), allocator);
    if (!schema.empty()) {
        add_member(result, "description", "as " + schema + ".schema.json has it", allocator);
        result["additionalProperties"].SetBool(true);
    }
    return result;
}

Report::Report(Provenance provenance, ReportLayout layout) : provenance_(std::move(provenance)), layout_(std::move(layout)) {
    result_.SetObject();
    run_.SetObject();
}

void Report::put(const std::string& key, JsonValue value, std::string text) {
    const Field* field = find_field(layout_.values, key);
    if (field == nullptr && layout_.schema.empty()) throw std::logic_error("the report declares no value '" + key + "'");
    set_member(result_, key, std::move(value), allocator());
    if (field != nullptr && !field->title.empty())
        blocks_.push_back({Block::Kind::value, field->title, text + (in_unit(*field).empty() ? "" : " " + in_unit(*field)), 0});
}

void Report::value(const std::string& key, bool value, std::optional<std::string> shown) {
    put(key, JsonValue(value), shown.value_or(value ? "yes" : "no"));
}
void Report::value(const std::string& key, double value, std::optional<std::string> shown) {
    if (std::isfinite(value)) put(key, JsonValue(value), shown.value_or(number(value)));
}
void Report::value(const std::string& key, const std::string& value, std::optional<std::string> shown) {
    put(key, json_string(value, allocator()), shown.value_or(value));
}
void Report::value(const std::string& key, const std::vector<double>& value, std::optional<std::string> shown) {
    put(key, list_of(value, allocator()), shown.value_or(text_of(value)));
}
void Report::value(const std::string& key, const std::vector<std::string>& value, std::optional<std::string> shown) {
    put(key, list_of(value, allocator()), shown.value_or(text_of(value)));
}
void Report::value(const std::string& key, JsonValue value) { put(key, std::move(value), {}); }
void Report::values(const JsonValue& object) {
    for (const auto& member : object.GetObject()) value(member.name.GetString(), JsonValue(member.value, allocator()));
}
void Report::integer(const std::string& key, std::int64_t value, std::optional<std::string> shown) {
    put(key, JsonValue(value), shown.value_or(std::to_string(value)));
}

Report::ShownTable& Report::table_of(const std::string& key) {
    if (const auto known = table_index_.find(key); known != table_index_.end()) return tables_[known->second];
    const auto layout = std::find_if(layout_.tables.begin(), layout_.tables.end(), [&](const auto& table) {
        return table.key.empty() ? table.title == key : table.key == key;
    });
    if (layout == layout_.tables.end()) throw std::logic_error("the report declares no table '" + key + "'");
    table_index_[key] = tables_.size();
    blocks_.push_back({Block::Kind::table, {}, {}, tables_.size()});
    if (!layout->key.empty()) set_member(result_, key, JsonValue(rapidjson::kArrayType), allocator());
    return tables_.emplace_back(ShownTable{static_cast<std::size_t>(layout - layout_.tables.begin()), {}});
}

void Report::empty_table(const std::string& table, bool shown) {
    if (shown) table_of(table);
    else set_member(result_, table, JsonValue(rapidjson::kArrayType), allocator());
}

Report::Row Report::row(const std::string& table) {
    ShownTable& shown = table_of(table);
    const auto& layout = layout_.tables[shown.layout];
    std::vector<std::string> cells;
    for (const Field& column : layout.columns)
        if (!column.title.empty()) cells.emplace_back(column.type == FieldType::number ? "-" : "");
    shown.rows.push_back(std::move(cells));
    if (!layout.key.empty())
        const_cast<JsonValue*>(find_member(result_, layout.key))->PushBack(JsonValue(rapidjson::kObjectType), allocator());
    return {*this, table_index_.at(table), shown.rows.size() - 1};
}

Report::Row& Report::Row::put(const std::string& key, JsonValue value, std::string text) {
    const auto& layout = report_.layout_.tables[report_.tables_[table_].layout];
    if (find_field(layout.columns, key) == nullptr || layout.key.empty())
        throw std::logic_error("table '" + layout.key + "' of the report declares no column '" + key + "'");
    JsonValue& list = *const_cast<JsonValue*>(find_member(report_.result_, layout.key));
    set_member(list[static_cast<rapidjson::SizeType>(row_)], key, std::move(value), report_.allocator());
    const auto is_here = [&](const Field& column) { return column.key == key && !column.title.empty(); };
    return std::any_of(layout.columns.begin(), layout.columns.end(), is_here) ? shown(key, text) : *this;
}

Report::Row& Report::Row::shown(const std::string& title_or_key, const std::string& text) {
    ShownTable& table = report_.tables_[table_];
    std::size_t at = 0;
    for (const Field& column : report_.layout_.tables[table.layout].columns) {
        if (column.title.empty()) continue;
        if (column.key.empty() ? column.title == title_or_key : column.key == title_or_key) {
            table.rows[row_][at] = text;
            return *this;
        }
        ++at;
    }
    throw std::logic_error("the report's table has no column '" + title_or_key + "' for people");
}

Report::Row& Report::Row::operator()(const std::string& key, bool value, std::optional<std::string> text) {
    return put(key, JsonValue(value), text.value_or(value ? "yes" : "no"));
}
Report::Row& Report::Row::operator()(const std::string& key, double value, std::optional<std::string> text) {
    return std::isfinite(value) ? put(key, JsonValue(value), text.value_or(number(value))) : *this;
}
Report::Row& Report::Row::operator()(const std::string& key, const std::string& value, std::optional<std::string> text) {
    return put(key, json_string(value, report_.allocator()), text.value_or(value));
}
Report::Row& Report::Row::operator()(const std::string& key, const std::vector<double>& value, std::optional<std::string> text) {
    return put(key, list_of(value, report_.allocator()), text.value_or(text_of(value)));
}
Report::Row& Report::Row::operator()(const std::string& key, const std::vector<std::string>& value,
                                     std::optional<std::string> text) {
    return put(key, list_of(value, report_.allocator()), text.value_or(text_of(value)));
}
Report::Row& Report::Row::operator()(const std::string& key, JsonValue value) { return put(key, std::move(value), {}); }
Report::Row& Report::Row::integer(const std::string& key, std::int64_t value, std::optional<std::string> text) {
    return put(key, JsonValue(value), text.value_or(std::to_string(value)));
}

void Report::people(const std::string& title, const std::string& text) {
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
        const std::string kind = finding.defect ? "defect" : "remark";
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "kind", kind, allocator());
        add_member(entry, place, finding.where, allocator());
        add_member(entry, "text", finding.text, allocator());
        list.PushBack(entry, allocator());
        rows.push_back({kind, finding.where, finding.text});
    }
    add_member(result_, "sound", JsonValue(defects == 0), allocator());
    add_member(result_, "defects", JsonValue(static_cast<std::uint64_t>(defects)), allocator());
    add_member(result_, "findings", std::move(list), allocator());
    if (!rows.empty()) {
        std::string text = plain_table({"kind", place, "what"}, rows);
        text.pop_back();
        line(text);
    }
    line(defects == 0 ? "no defects" : std::to_string(defects) + (defects == 1 ? " defect" : " defects"));
    if (defects > 0) answer_no();
}

void Report::run(const std::string& key, double value) { set_member(run_, key, JsonValue(value), run_.GetAllocator()); }

Json Report::to_json() const {
    Json report(rapidjson::kObjectType);
    auto& allocator = report.GetAllocator();
    add_member(report, "format", "ostraka-report", allocator);
    add_member(report, "command", provenance_.command, allocator);
    JsonValue result(result_, allocator);
    if (find_member(result, "notes") == nullptr) add_member(result, "notes", list_of(notes_, allocator), allocator);
    add_member(report, "result", std::move(result), allocator);
    add_member(report, "provenance", provenance_.to_json(allocator), allocator);
    if (run_.MemberCount() > 0) add_member(report, "run", JsonValue(run_, allocator), allocator);
    return report;
}

std::string Report::times() const {
    std::string text;
    const std::function<void(const JsonValue&)> add = [&](const JsonValue& object) {
        for (const auto& member : object.GetObject())
            if (member.value.IsObject()) add(member.value);
            else if (const std::string name = member.name.GetString(); name != "threads")
                text += (text.empty() ? "" : ", ") + (name == "seconds" ? "" : name + " ") + number(member.value.GetDouble(), 3) +
                        " s";
    };
    add(run_);
    return text;
}

std::string Report::in_unit(const Field& field) const {
    std::string text = field.unit;
    const std::size_t at = text.find("length");
    if (at == std::string::npos) return text;
    return unit_.empty() ? "" : text.replace(at, 6, printable(unit_, 20));
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
            if (format != ReportFormat::csv) text += block.text + "\n";
        } else if (block.kind == Block::Kind::table || block.kind == Block::Kind::text_table) {
            const TextTable* own = block.text_table.get();
            const std::string shown = own == nullptr                  ? shown_table(tables_[block.table], format)
                                      : format == ReportFormat::table ? own->plain()
                                      : format == ReportFormat::csv   ? own->csv()
                                                                      : own->markdown();
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

std::string plain_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::vector<std::string>> all{header};
    for (const auto& row : rows) {
        all.push_back(row);
        all.back().resize(header.size());
        for (auto& cell : all.back()) cell = printable(cell, std::string::npos);
    }
    const auto counts = [](const std::string& cell) { return cell.empty() || cell == "-" || is_number(cell); };
    return aligned_rows(all, [&](std::size_t row, std::size_t column) {
        if (row > 0) return is_number(all[row][column]);
        return all.size() > 1 &&
               std::all_of(all.begin() + 1, all.end(), [&](const auto& cells) { return counts(cells[column]); });
    });
}

std::string plain_values(const std::vector<std::pair<std::string, std::string>>& rows) {
    std::size_t widest = 0;
    for (const auto& [name, value] : rows) widest = std::max(widest, shown_width(name));
    std::string text;
    for (const auto& [name, value] : rows)
        text += name + std::string(widest - shown_width(name) + 2, ' ') + printable(value, std::string::npos) + "\n";
    return text;
}

std::string number(double value, int digits) { return ostraka::digits(value, digits); }

std::string printable(const std::string& text, std::size_t most) {
    std::string clean;
    std::size_t columns = 0;
    for (std::size_t at = 0; at < text.size();) {
        const Character here = character_at(text, at);
        if (++columns > most) return clean + "...";
        // A byte that begins no character may steer a terminal that does not read UTF-8.
        const bool odd = is_control(here.code) || (here.code == 0xFFFD && here.length == 1);
        clean += odd ? "?" : text.substr(at, here.length);
        at += here.length;
    }
    return clean;
}

}  // namespace ostraka
