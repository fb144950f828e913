// Checks the tables, plots and the page of a study before the first step runs.
#include "workflow/row_sources.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/workflow/collect.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

[[noreturn]] void refuse(const Study& study, const std::string& place, const std::string& problem, const std::string& name,
                         const std::vector<std::string>& names) {
    const std::string suggestion = nearest_name(name, names);
    fail_input(study.at(place), problem,
               !suggestion.empty() ? fmt::format("did you mean '{}'?", suggestion)
               : names.empty()     ? "none is defined"
                                   : "defined: " + printable(joined(names), 400));
}

std::vector<std::string> step_names(const Study& study) {
    std::vector<std::string> names;
    for (const auto& step : study.steps) names.push_back(step.name);
    return names;
}

std::vector<std::pair<std::string, std::string>> row_texts(const JsonValue& rows, const std::string& place) {
    std::vector<std::pair<std::string, std::string>> texts;
    if (rows.IsString()) texts.emplace_back(text_of(rows), place + "/rows");
    else
        for (rapidjson::SizeType i = 0; i < rows.Size(); ++i)
            texts.emplace_back(text_of(rows[i]), fmt::format("{}/rows/{}", place, i));
    return texts;
}

std::vector<std::string> parameter_names(const Study& study) {
    std::vector<std::string> names;
    for (const auto& parameter : study.parameters) names.push_back(parameter.name);
    return names;
}

/// Checks one table of a study against the reports of the steps that give its rows.
class TableCheck {
public:
    TableCheck(const Study& study, const std::string& name, const JsonValue& table)
        : study_(study),
          table_(table),
          columns_(*find_member(table, "columns")),
          place_("/tables/" + name),
          sources_(row_sources(study, table, place_)) {}

    void run() {
        for (const RowSource& source : sources_) check_source(source);
        if (columns_.IsString() && sources_.size() > 1)
            fail_input(study_.at(place_ + "/rows"), "'all' selects the columns of one file, but 'rows' names several",
                       "list the columns, or name one file");
        for (rapidjson::SizeType k = 0; columns_.IsArray() && k < columns_.Size(); ++k)
            check_column(columns_[k], fmt::format("{}/columns/{}", place_, k));
        if (const JsonValue* beside = find_member(table_, "beside"))
            for (rapidjson::SizeType k = 0; k < beside->Size(); ++k)
                check_beside((*beside)[k], fmt::format("{}/beside/{}", place_, k));
    }

private:
    void check_source(const RowSource& source) const {
        const StudyStep& step = study_.steps[source.step];
        if (step.operation == nullptr) {
            if (!source.table.ends_with(".csv"))
                fail_input(study_.at(place_ + "/rows"), fmt::format("'{}' runs a program, which has no report", step.name),
                           fmt::format("name a CSV file that it writes: {}.FILE.csv", step.name));
            return;
        }
        if (columns_.IsString())
            fail_input(study_.at(place_ + "/columns"),
                       fmt::format("'all' applies only to CSV files of programs, and '{}' is an operation", step.name),
                       "name the columns: its page in doc/commands lists what it reports");
        const Call call(*step.operation);
        const ReportLayout& layout = call.parameters().report;
        std::vector<std::string> tables, values, columns;
        for (const auto& field : layout.value_fields) values.push_back(field.key);
        for (const auto& reported : layout.tables) {
            if (!reported.key.empty()) tables.push_back(reported.key);
            if (reported.key != source.table) continue;
            for (const auto& column : reported.columns)
                if (!column.key.empty()) columns.push_back(column.key);
        }
        const bool is_listed = !layout.schema.empty();  // the report has further keys, which only its schema lists
        if (!source.table.empty() && !is_listed && std::find(tables.begin(), tables.end(), source.table) == tables.end())
            refuse(study_, place_ + "/rows",
                   fmt::format("'{}' reports no table '{}'", step.operation->name, printable(source.table, 60)), source.table,
                   tables);
        for (rapidjson::SizeType k = 0; k < columns_.Size(); ++k) {
            const std::string value = text_in(columns_[k], "value"), at = fmt::format("{}/columns/{}/value", place_, k);
            if (source.table.empty() && value.starts_with("row."))
                fail_input(study_.at(at),
                           fmt::format("refers to a row of a table, but the rows here are the instances of '{}'", step.name),
                           fmt::format("name a table of its report in 'rows', such as {}.{}", step.name,
                                       tables.empty() ? "TABLE" : tables.front()));
            if (is_listed) continue;
            check_key(value, "row.", columns, fmt::format("'{}' reports no column", step.operation->name), at);
            check_key(value, "result.", values, fmt::format("'{}' reports no value", step.operation->name), at);
        }
    }

    /// Throws Error if a value with this prefix has a key that is none of `known_keys`, part of one or a member of one.
    void check_key(const std::string& value, std::string_view prefix, const std::vector<std::string>& known_keys,
                   const std::string& problem, const std::string& at) const {
        if (!value.starts_with(prefix)) return;
        const std::string key = value.substr(prefix.size());
        const bool is_known = std::any_of(known_keys.begin(), known_keys.end(), [&](const std::string& known_key) {
            return known_key == key || key.starts_with(known_key + ".") || known_key.starts_with(key + ".");
        });
        if (!is_known) refuse(study_, at, fmt::format("{} '{}'", problem, printable(key, 60)), key, known_keys);
    }

    void check_column(const JsonValue& column, const std::string& at) {
        const std::string value = text_in(column, "value"), title = text_in(column, "title");
        if (std::find(titles_.begin(), titles_.end(), title) != titles_.end())
            fail_input(study_.at(at + "/title"), fmt::format("'{}' is the title of two columns", printable(title, 60)),
                       "give each column its own title");
        titles_.push_back(title);
        const StudyText text = study_text(value, study_.at(at + "/value"));
        const bool is_special = value.starts_with("row.") || value.starts_with("result.") || value.starts_with("run.") ||
                                value == "step" || value == "holds" || value == "seconds";
        if (!is_special && text.references().empty())
            fail_input(study_.at(at + "/value"), fmt::format("'{}' does not name a value", printable(value, 60)),
                       "write result.KEY, row.KEY, run.KEY, ${PARAMETER}, step, holds or seconds");
        for (const StudyReference& reference : text.references()) check_reference(reference, at + "/value");
    }

    void check_reference(const StudyReference& reference, const std::string& at) const {
        const StudyParameter* parameter = study_.parameter(reference.name);
        if (parameter == nullptr)
            refuse(study_, at, fmt::format("there is no parameter '{}'", printable(reference.name, 60)), reference.name,
                   parameter_names(study_));
        if (parameter->values.front().find(reference.member) == nullptr)
            fail_input(study_.at(at), fmt::format("'{}' has no member '{}'", reference.name, printable(reference.member, 60)),
                       "name a member that its values have");
        for (const RowSource& source : sources_)
            if (parameter->varies && !study_.steps[source.step].parameters[study_.parameter_index(reference.name)])
                fail_input(study_.at(at),
                           fmt::format("step '{}' does not vary with '{}'", study_.steps[source.step].name, reference.name),
                           "leave the column out, or use the parameter in the step");
    }

    void check_beside(const JsonValue& row, const std::string& at) const {
        std::size_t known_columns = 0;
        for (const auto& member : row.GetObject())
            known_columns += std::find(titles_.begin(), titles_.end(), text_of(member.name)) != titles_.end() ? 1 : 0;
        if (known_columns == 0 || known_columns == row.MemberCount())
            fail_input(study_.at(at),
                       known_columns == 0 ? "names no column of the table, so that its row cannot be found"
                                          : "adds nothing to the columns of the table",
                       "give values of existing columns, which select the rows, and of further columns to add");
    }

    const Study& study_;
    const JsonValue& table_;
    const JsonValue& columns_;
    std::string place_;
    std::vector<RowSource> sources_;
    std::vector<std::string> titles_;
};

}  // namespace

bool is_left_out(const Study& study, const std::string& step) {
    return study.step(step) == study.steps.size() && find_member(*find_member(*study.document, "steps"), step) != nullptr;
}

std::vector<RowSource> row_sources(const Study& study, const JsonValue& table, const std::string& place) {
    std::vector<RowSource> sources;
    for (const auto& [text, at] : row_texts(*find_member(table, "rows"), place)) {
        const std::size_t dot = text.find('.');
        const std::string step = text.substr(0, dot);
        if (is_left_out(study, step)) continue;
        const std::size_t i = study.step(step);
        if (i == study.steps.size())
            refuse(study, at, fmt::format("there is no step '{}'", printable(step, 60)), step, step_names(study));
        sources.push_back({i, dot == std::string::npos ? "" : text.substr(dot + 1)});
    }
    return sources;
}

void check_collected(const StudyPlan& plan) {
    const Study& study = plan.study;
    std::map<std::string, std::vector<std::string>> titles;
    std::vector<std::string> page_names;
    const auto check_name = [&](const std::string& place, const std::string& name) {
        const bool is_valid = !name.empty() && name.size() <= 60 &&
                              std::all_of(name.begin(), name.end(),
                                          [](char c) {
                                              return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                                                     c == '-' || c == '_' || c == '.';
                                          }) &&
                              name[0] != '.' && name != "page";
        if (!is_valid)
            fail_input(study.at(place), "cannot be used as a file name", "use letters, digits, '-', '_' and '.', and not 'page'");
        if (std::find(page_names.begin(), page_names.end(), name) != page_names.end())
            fail_input(study.at(place), "is already the name of a table", "give the plot another name");
        page_names.push_back(name);
    };
    if (const JsonValue* tables = find_member(*study.document, "tables"))
        for (const auto& member : tables->GetObject()) {
            const std::string name = text_of(member.name);
            check_name("/tables/" + name, name);
            TableCheck(study, name, member.value).run();
            for (const auto& column : list_in(member.value, "columns")) titles[name].push_back(text_in(column, "title"));
            for (const auto& row : list_in(member.value, "beside"))
                for (const auto& cell : row.GetObject()) titles[name].push_back(text_of(cell.name));
        }
    if (const JsonValue* plots = find_member(*study.document, "plots"))
        for (const auto& member : plots->GetObject()) {
            const std::string name = text_of(member.name), place = "/plots/" + name, table = text_in(member.value, "table");
            check_name(place, name);
            std::vector<std::string> tables;
            for (const auto& [table_name, columns] : titles) tables.push_back(table_name);
            if (!titles.contains(table))
                refuse(study, place + "/table", fmt::format("there is no table '{}'", printable(table, 60)), table, tables);
            const auto check_column = [&](const std::string& title, const std::string& at) {
                const auto& table_columns = titles.at(table);
                if (std::find(table_columns.begin(), table_columns.end(), title) == table_columns.end())
                    refuse(study, fmt::format("{}/{}", place, at),
                           fmt::format("table '{}' has no column '{}'", table, printable(title, 60)), title, table_columns);
            };
            check_column(text_in(member.value, "x"), "x");
            if (const JsonValue& y = *find_member(member.value, "y"); y.IsString()) check_column(text_of(y), "y");
            else
                for (const auto& y_column : y.GetArray()) check_column(text_of(y_column), "y");
            if (find_member(member.value, "series") != nullptr) check_column(text_in(member.value, "series"), "series");
        }
    const auto sections = list_in(*study.document, "page");
    for (rapidjson::SizeType k = 0; k < sections.Size(); ++k) {
        const auto shown_names = list_in(sections[k], "show");
        for (rapidjson::SizeType i = 0; i < shown_names.Size(); ++i) {
            const std::string name = text_of(shown_names[i]), place = fmt::format("/page/{}/show/{}", k, i);
            if (std::find(page_names.begin(), page_names.end(), name) != page_names.end()) continue;
            const std::size_t dot = name.find('.');
            const std::string step = name.substr(0, dot);
            if (dot == std::string::npos || (study.step(step) == study.steps.size() && !is_left_out(study, step)))
                refuse(study, place, fmt::format("there is no table, plot or output of a step '{}'", printable(name, 60)), name,
                       page_names);
            const std::size_t s = study.step(step);
            if (s < study.steps.size() && study.steps[s].operation != nullptr &&
                !study.steps[s].keep.contains(name.substr(dot + 1)))
                fail_input(study.at(place), fmt::format("'{}' is not kept", name), "list the output in 'keep' of its step");
        }
    }
}

}  // namespace ostraka
