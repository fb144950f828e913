#include "ostraka/workflow/collect.h"

#include "workflow/row_sources.h"

#include "ostraka/core/message_text.h"
#include "ostraka/figures/markdown.h"
#include "ostraka/figures/plot.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

const JsonValue* at_path(const JsonValue& value, const std::string& path) {
    if (const JsonValue* member = find_member(value, path)) return member;
    const std::size_t dot = path.find('.');
    if (dot == std::string::npos) return nullptr;
    const JsonValue* inner = find_member(value, path.substr(0, dot));
    return inner == nullptr ? nullptr : at_path(*inner, path.substr(dot + 1));
}

Json copy_of(const JsonValue* value) {
    Json copy;
    if (value != nullptr) copy.CopyFrom(*value, copy.GetAllocator());
    return copy;
}

std::string cell_text(const JsonValue& value, int digits_shown, bool percent) {
    if (value.IsNull()) return "-";
    if (value.IsInt64() && !percent) return std::to_string(value.GetInt64());
    if (value.IsNumber())
        return percent ? digits(100 * value.GetDouble(), digits_shown) : digits(value.GetDouble(), digits_shown);
    if (value.IsString() || value.IsBool()) return scalar_text(value);
    if (!value.IsArray()) return to_compact_text(value);
    std::vector<std::string> texts;
    for (const auto& element : value.GetArray()) texts.push_back(cell_text(element, digits_shown, percent));
    return joined(texts, ", ");
}

double statistic_of(std::vector<double> values, const std::string& statistic) {
    if (statistic == "count") return static_cast<double>(values.size());
    if (values.empty()) return std::nan("");
    const double count = static_cast<double>(values.size()), sum = std::accumulate(values.begin(), values.end(), 0.0);
    if (statistic == "sum") return sum;
    if (statistic == "mean") return sum / count;
    std::sort(values.begin(), values.end());
    if (statistic == "minimum") return values.front();
    if (statistic == "maximum") return values.back();
    if (statistic == "median")
        return values.size() % 2 == 1 ? values[values.size() / 2]
                                      : (values[values.size() / 2 - 1] + values[values.size() / 2]) / 2;
    double squares = 0;
    for (const double value : values) squares += (value - sum / count) * (value - sum / count);
    return values.size() < 2 ? std::nan("") : std::sqrt(squares / (count - 1));
}

class TableMaker {
public:
    TableMaker(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder, std::string name,
               const JsonValue& description)
        : plan_(plan),
          results_(results),
          folder_(folder),
          description_(description),
          columns_(*find_member(description, "columns")) {
        table_.name = std::move(name);
        table_.title = text_in(description, "title");
        table_.note = text_in(description, "note");
        for (const auto& column : list_in(description, "columns")) {
            table_.columns.push_back(text_in(column, "title"));
            table_.digits.push_back(static_cast<int>(number_or(column, "digits", 4)));
            table_.percent.push_back(flag_in(column, "percent"));
        }
    }

    StudyTable make() {
        for (const RowSource& source : row_sources(plan_.study, description_, "/tables/" + table_.name))
            for (const std::size_t i : plan_.instances_of(source.step)) {
                const InstanceState state = results_[i].state;
                if (state == InstanceState::done || state == InstanceState::unchanged) add_instance(i, source.table);
            }
        summarise();
        add_beside();
        return std::move(table_);
    }

private:
    void add_instance(std::size_t i, const std::string& rows) {
        const StudyInstance& instance = plan_.instances[i];
        const Path folder = folder_ / instance.folder;
        const Json report = read_json(folder / "report.json");
        if (plan_.study.steps[instance.step].operation == nullptr) {
            const std::string text = read_file(folder / rows);
            const auto lines = csv_rows(text, csv_separator(text), (folder / rows).string());
            if (columns_.IsString() && !lines.empty() && table_.columns.empty())
                for (const std::string& name : lines[0].cells) add_column(unescape_formula(name), 4);
            for (std::size_t k = 1; k < lines.size(); ++k) {
                Json row(rapidjson::kObjectType);
                auto& allocator = row.GetAllocator();
                for (std::size_t c = 0; c < std::min(lines[0].cells.size(), lines[k].cells.size()); ++c) {
                    const std::string& cell = lines[k].cells[c];
                    const auto value = number_of(cell);
                    if (value && *value == std::floor(*value) && std::abs(*value) < 1e15)
                        add_members(row, allocator, unescape_formula(lines[0].cells[c]), static_cast<std::int64_t>(*value));
                    else if (value) add_members(row, allocator, unescape_formula(lines[0].cells[c]), *value);
                    else if (!cell.empty())
                        add_members(row, allocator, unescape_formula(lines[0].cells[c]), unescape_formula(cell));
                }
                add_row(i, report, row);
            }
            return;
        }
        if (rows.empty()) return add_row(i, report, Json());
        const JsonValue* result = find_member(report, "result");
        const JsonValue* rows_value = result == nullptr ? nullptr : at_path(*result, rows);
        if (rows_value == nullptr || !rows_value->IsArray()) return;
        for (const auto& row : rows_value->GetArray()) add_row(i, report, row);
    }

    void add_row(std::size_t i, const JsonValue& report, const JsonValue& row) {
        const StudyInstance& instance = plan_.instances[i];
        std::vector<Json> cells;
        if (columns_.IsString())
            for (const std::string& name : table_.columns) cells.push_back(copy_of(find_member(row, name)));
        for (const auto& column : list_in(description_, "columns")) {
            const std::string value = text_in(column, "value");
            const auto behind = [&](std::string_view prefix) { return value.substr(prefix.size()); };
            if (value.starts_with("row.")) cells.push_back(copy_of(at_path(row, behind("row."))));
            else if (value.starts_with("result.") || value.starts_with("run.")) cells.push_back(copy_of(at_path(report, value)));
            else if (value == "step") cells.push_back(text_cell(plan_.study.steps[instance.step].name));
            else if (value == "holds") cells.emplace_back().SetBool(results_[i].record.holds);
            else if (value == "seconds") cells.emplace_back().SetDouble(results_[i].record.seconds);
            else cells.push_back(parameter_cell(instance, value));
        }
        table_.cells.push_back(std::move(cells));
    }

    void add_column(const std::string& title, int digits_shown) {
        table_.columns.push_back(title);
        table_.digits.push_back(digits_shown);
        table_.percent.push_back(false);
    }

    static Json text_cell(const std::string& text) {
        Json cell;
        cell.SetString(text, cell.GetAllocator());
        return cell;
    }

    Json parameter_cell(const StudyInstance& instance, const std::string& text) const {
        const StudyText parts = study_text(text, "");
        if (const StudyReference* reference = parts.single()) return copy_of(plan_.value(instance, *reference));
        std::string text_value;
        for (const auto& part : parts.parts)
            if (const auto* literal = std::get_if<std::string>(&part)) text_value += *literal;
            else if (const JsonValue* value = plan_.value(instance, std::get<StudyReference>(part)))
                text_value += scalar_text(*value);
        return text_cell(text_value);
    }

    /// Merges rows that agree in all columns without a statistic.
    void summarise() {
        std::vector<std::string> statistics;
        for (const auto& column : list_in(description_, "columns")) statistics.push_back(text_in(column, "statistic"));
        if (std::all_of(statistics.begin(), statistics.end(), [](const std::string& statistic) { return statistic.empty(); }))
            return;
        std::vector<std::vector<Json>> groups;
        std::vector<std::vector<std::vector<double>>> values;
        std::map<std::string, std::size_t> places;
        for (auto& row : table_.cells) {
            std::string key;
            for (std::size_t c = 0; c < row.size(); ++c)
                if (statistics[c].empty()) key += to_compact_text(row[c]) + "\n";
            const auto [place, is_new] = places.emplace(key, groups.size());
            if (is_new) values.emplace_back(row.size());
            for (std::size_t c = 0; c < row.size(); ++c)
                if (row[c].IsNumber()) values[place->second][c].push_back(row[c].GetDouble());
                else if (row[c].IsBool()) values[place->second][c].push_back(row[c].GetBool() ? 1 : 0);
            if (is_new) groups.push_back(std::move(row));
        }
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (std::size_t c = 0; c < statistics.size(); ++c) {
                if (statistics[c].empty()) continue;
                const double value = statistic_of(values[g][c], statistics[c]);
                if (!std::isfinite(value)) groups[g][c].SetNull();
                else if (statistics[c] == "count") groups[g][c].SetInt64(static_cast<std::int64_t>(value));
                else groups[g][c].SetDouble(value);
            }
        table_.cells = std::move(groups);
    }

    void add_beside() {
        const JsonValue* beside = find_member(description_, "beside");
        if (beside == nullptr) return;
        const std::size_t measured_columns = table_.columns.size();
        for (const auto& row : beside->GetArray())
            for (const auto& member : row.GetObject())
                if (const std::string title = text_of(member.name); table_.column(title) == table_.columns.size()) {
                    add_column(title, 6);
                }
        for (auto& cells : table_.cells) {
            cells.resize(table_.columns.size());
            for (const auto& row : beside->GetArray()) {
                bool agrees = true;
                for (const auto& member : row.GetObject())
                    if (const std::size_t c = table_.column(text_of(member.name)); c < measured_columns)
                        agrees =
                            agrees && !cells[c].IsNull() && cell_text(cells[c], 17, false) == cell_text(member.value, 17, false);
                if (!agrees) continue;
                for (const auto& member : row.GetObject())
                    if (const std::size_t c = table_.column(text_of(member.name)); c >= measured_columns)
                        cells[c] = copy_of(&member.value);
            }
        }
    }

    const StudyPlan& plan_;
    const std::vector<InstanceResult>& results_;
    const Path& folder_;
    const JsonValue& description_;
    const JsonValue& columns_;
    StudyTable table_;
};

Plot plot_of(const JsonValue& description, const StudyTable& table) {
    Plot plot;
    plot.title = text_in(description, "title");
    const std::size_t x = table.column(text_in(description, "x"));
    plot.x.label = table.columns[x];
    std::vector<std::string> ys;
    if (const JsonValue& y = *find_member(description, "y"); y.IsString()) ys.push_back(text_of(y));
    else
        for (const auto& y_column : y.GetArray()) ys.push_back(text_of(y_column));
    plot.y.label = joined(ys);
    if (const JsonValue* axes = find_member(description, "logarithmic"))
        for (const auto& axis : axes->GetArray()) (text_of(axis) == "x" ? plot.x : plot.y).logarithmic = true;
    const std::string series_column = text_in(description, "series");
    const bool named = std::any_of(table.cells.begin(), table.cells.end(), [&](const auto& row) { return !row[x].IsNumber(); });
    std::map<std::string, std::size_t> places;
    for (std::size_t r = 0; r < table.cells.size(); ++r) {
        const auto& row = table.cells[r];
        double at = 0;
        if (named) {
            const std::string name = cell_text(row[x], 6, false);
            const auto category = std::find(plot.x.names.begin(), plot.x.names.end(), name);
            at = static_cast<double>(category - plot.x.names.begin());
            if (category == plot.x.names.end()) plot.x.names.push_back(name);
        } else {
            at = row[x].GetDouble();
        }
        for (const std::string& y : ys) {
            const std::size_t c = table.column(y);
            std::string series = series_column.empty() ? "" : cell_text(row[table.column(series_column)], 6, false);
            if (ys.size() > 1) series += (series.empty() ? "" : ", ") + y;
            const auto [place, is_new] = places.emplace(series, plot.series.size());
            if (is_new) plot.series.push_back({.name = series, .joined = !named});
            if (row[c].IsNumber())
                plot.series[place->second].points.push_back({at, (table.percent[c] ? 100 : 1) * row[c].GetDouble()});
        }
    }
    for (PlotSeries& series : plot.series) std::sort(series.points.begin(), series.points.end());
    return plot;
}

bool has_points(const Plot& plot) {
    return std::any_of(plot.series.begin(), plot.series.end(), [&](const PlotSeries& series) {
        return std::any_of(series.points.begin(), series.points.end(),
                           [&](const auto& p) { return (!plot.x.logarithmic || p[0] > 0) && (!plot.y.logarithmic || p[1] > 0); });
    });
}

}  // namespace

TextTable StudyTable::text() const {
    std::vector<TableColumn> heads;
    for (std::size_t c = 0; c < columns.size(); ++c)
        heads.emplace_back(columns[c] + (percent[c] ? ", %" : ""), std::vector{columns[c]});
    TextTable table(heads);
    for (const auto& row : cells) {
        std::vector<TableCell> texts;
        for (std::size_t c = 0; c < columns.size(); ++c)
            texts.emplace_back(cell_text(row[c], digits[c], percent[c]),
                               std::vector{row[c].IsNull() ? std::string() : cell_text(row[c], 17, false)});
        table.add(texts);
    }
    return table;
}

std::size_t StudyTable::column(const std::string& wanted_title) const {
    return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), wanted_title) - columns.begin());
}

std::vector<StudyTable> collect_tables(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder) {
    std::vector<StudyTable> tables_of_study;
    if (const JsonValue* tables = find_member(*plan.study.document, "tables"))
        for (const auto& member : tables->GetObject())
            tables_of_study.push_back(TableMaker(plan, results, folder, text_of(member.name), member.value).make());
    return tables_of_study;
}

std::vector<std::string> write_study_tables(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
                                            const std::function<Path(const std::string&)>& write) {
    const Study& study = plan.study;
    std::vector<std::string> names;
    const auto write_text = [&](const std::string& name, const std::string& text) {
        write_file(write(name), text);
        names.push_back(name);
    };
    std::map<std::string, std::string> parts;  // sections of the page
    std::vector<std::string> order;
    std::map<std::string, StudyTable> tables;
    for (StudyTable& table : collect_tables(plan, results, folder)) {
        const TextTable text = table.text();
        write_text(table.name + ".csv", text.csv());
        write_text(table.name + ".md", text.markdown());
        write_text(table.name + ".tex", text.latex(table.title));
        parts[table.name] = (table.title.empty() ? "" : fmt::format("**{}**\n\n", markdown_text(table.title))) +
                            (table.note.empty() ? "" : markdown_paragraphs(table.note) + "\n\n") +
                            (text.size() == 0 ? "Nothing to show yet.\n" : text.markdown());
        order.push_back(table.name);
        tables.emplace(table.name, std::move(table));
    }
    if (const JsonValue* plots = find_member(*study.document, "plots"))
        for (const auto& member : plots->GetObject()) {
            const std::string name = text_of(member.name);
            const Plot plot = plot_of(member.value, tables.at(text_in(member.value, "table")));
            order.push_back(name);
            if (!has_points(plot)) continue;
            write_plot(write(name + ".svg"), plot);
            names.push_back(name + ".svg");
            parts[name] =
                fmt::format("![{}]({}.svg)\n", markdown_text(plot.title.empty() ? name : plot.title), markdown_file(name));
        }
    // Titles and texts of a study are plain text: their markup is escaped.
    std::string page = fmt::format("# {}\n", markdown_text(study.title.empty() ? study.file.filename().string() : study.title));
    if (const std::string note = text_in(*study.document, "note"); !note.empty())
        page += fmt::format("\n{}\n", markdown_paragraphs(note));
    const auto show = [&](const std::string& name) {
        if (const auto known = parts.find(name); known != parts.end()) {
            page += "\n" + known->second;
            return;
        }
        const std::size_t dot = name.find('.');
        const std::size_t s = dot == std::string::npos ? study.steps.size() : study.step(name.substr(0, dot));
        if (s == study.steps.size()) return;
        for (const std::size_t i : plan.instances_of(s)) {
            const auto& outputs = results[i].record.outputs;
            const auto output = outputs.find(name.substr(dot + 1));
            if (output == outputs.end() || !output->second.kept) continue;
            const std::string file = (plan.instances[i].folder / output->second.file).generic_string();
            const bool is_picture = file.ends_with(".png") || file.ends_with(".svg");
            page += fmt::format("\n{}[{}](<{}>)\n", is_picture ? "!" : "", markdown_text(plan.instances[i].title(study)),
                                markdown_file(file));
        }
    };
    const auto sections = list_in(*study.document, "page");
    for (const auto& section : sections) {
        if (const std::string title = text_in(section, "title"); !title.empty())
            page += fmt::format("\n## {}\n", markdown_text(title));
        if (const std::string text = text_in(section, "text"); !text.empty())
            page += fmt::format("\n{}\n", markdown_paragraphs(text));
        for (const auto& shown_name : list_in(section, "show")) show(text_of(shown_name));
    }
    if (sections.Empty())
        for (const std::string& name : order) show(name);
    std::string problems;
    for (std::size_t i = 0; i < results.size(); ++i)
        if (results[i].state == InstanceState::failed)
            problems +=
                fmt::format("- {}\n", markdown_text(fmt::format("{}: {}", plan.instances[i].title(study), results[i].problem)));
    if (!problems.empty()) page += "\n## What failed\n\n" + problems;
    write_text("page.md", page);
    return names;
}

}  // namespace ostraka
