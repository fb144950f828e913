// Checks the tables, plots and the page of a study before the first step runs.
#include "row_sources.h"

#include "ostraka/core/nearest_name.h"
#include "ostraka/core/words.h"
#include "ostraka/workflow/collect.h"

#include <algorithm>

namespace ostraka {

namespace {

[[noreturn]] void refuse(const Study& study, const std::string& place, const std::string& what, const std::string& name,
                         const std::vector<std::string>& names) {
    const std::string near = nearest_name(name, names);
    fail_input(study.at(place), what,
               !near.empty()   ? "did you mean '" + near + "'?"
               : names.empty() ? "there is none"
                               : "there are: " + printable(joined(names), 400));
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
            texts.emplace_back(text_of(rows[i]), place + "/rows/" + std::to_string(i));
    return texts;
}

void check_table(const StudyPlan& plan, const std::string& name, const JsonValue& table) {
    const Study& study = plan.study;
    const std::string place = "/tables/" + name;
    const auto sources = row_sources(study, table, place);
    for (const RowSource& source : sources) {
        const StudyStep& step = study.steps[source.step];
        if (step.operation == nullptr) {
            if (!source.table.ends_with(".csv"))
                fail_input(study.at(place + "/rows"), "'" + step.name + "' is a program",
                           "name a CSV file that it writes: " + step.name + ".FILE.csv");
            continue;
        }
        if (find_member(table, "columns")->IsString())
            fail_input(study.at(place + "/columns"), "'all' is for files of programs, and '" + step.name + "' is an operation",
                       "name the columns: its page in doc/commands lists what it reports");
        const Call call(*step.operation);
        const ReportLayout& layout = call.parameters().report;
        std::vector<std::string> tables, values, columns;
        for (const auto& one : layout.tables)
            if (!one.key.empty()) tables.push_back(one.key);
        for (const auto& one : layout.of_values) values.push_back(one.key);
        if (!source.table.empty() && layout.schema.empty() &&
            std::find(tables.begin(), tables.end(), source.table) == tables.end())
            refuse(study, place + "/rows",
                   "'" + std::string(step.operation->name) + "' reports no table '" + printable(source.table, 60) + "'",
                   source.table, tables);
        for (const auto& one : layout.tables)
            if (one.key == source.table)
                for (const auto& column : one.columns)
                    if (!column.key.empty()) columns.push_back(column.key);
        const JsonValue& list = *find_member(table, "columns");
        for (rapidjson::SizeType k = 0; k < list.Size(); ++k) {
            const std::string value = text_in(list[k], "value"), at = place + "/columns/" + std::to_string(k) + "/value";
            const auto check = [&](std::string_view prefix, const std::vector<std::string>& known, const std::string& what) {
                if (!value.starts_with(prefix)) return;
                const std::string key = value.substr(prefix.size());
                const bool is_known = std::any_of(known.begin(), known.end(), [&](const std::string& one) {
                    return one == key || key.starts_with(one + ".") || one.starts_with(key + ".");
                });
                if (!is_known && layout.schema.empty())
                    refuse(study, at,
                           "'" + std::string(step.operation->name) + "' reports no " + what + " '" + printable(key, 60) + "'",
                           key, known);
            };
            if (source.table.empty() && value.starts_with("row."))
                fail_input(
                    study.at(at), "names a row, and the rows are the instances of '" + step.name + "'",
                    "name a table of its report in 'rows': " + step.name + "." + (tables.empty() ? "TABLE" : tables.front()));
            check("row.", columns, "column");
            check("result.", values, "value");
        }
    }
    std::vector<std::string> titles;
    const JsonValue& list = *find_member(table, "columns");
    if (list.IsString() && sources.size() > 1)
        fail_input(study.at(place + "/rows"), "several files, and 'all' their columns", "name the columns, or one file");
    for (rapidjson::SizeType k = 0; list.IsArray() && k < list.Size(); ++k) {
        const std::string value = text_in(list[k], "value"), title = text_in(list[k], "title"),
                          at = place + "/columns/" + std::to_string(k);
        if (std::find(titles.begin(), titles.end(), title) != titles.end())
            fail_input(study.at(at + "/title"), "'" + printable(title, 60) + "' is the title of two columns",
                       "give each its own");
        titles.push_back(title);
        const StudyText text = study_text(value, study.at(at + "/value"));
        const bool plain = value.starts_with("row.") || value.starts_with("result.") || value.starts_with("run.") ||
                           value == "step" || value == "holds" || value == "seconds";
        if (!plain && text.references().empty())
            fail_input(study.at(at + "/value"), "'" + printable(value, 60) + "' names no value",
                       "write result.KEY, row.KEY, run.KEY, ${PARAMETER}, step, holds or seconds");
        for (const StudyReference& reference : text.references()) {
            std::vector<std::string> names;
            for (const auto& one : study.parameters) names.push_back(one.name);
            const StudyParameter* parameter = study.parameter(reference.name);
            if (parameter == nullptr)
                refuse(study, at + "/value", "there is no parameter '" + printable(reference.name, 60) + "'", reference.name,
                       names);
            if (parameter->values.front().find(reference.member) == nullptr)
                fail_input(study.at(at + "/value"),
                           "'" + reference.name + "' has no member '" + printable(reference.member, 60) + "'",
                           "name one that its values have");
            for (const RowSource& source : sources)
                if (parameter->varies && !study.steps[source.step].parameters[study.parameter_index(reference.name)])
                    fail_input(study.at(at + "/value"),
                               "step '" + study.steps[source.step].name + "' does not vary with '" + reference.name + "'",
                               "leave the column out, or use the parameter in the step");
        }
    }
    if (const JsonValue* beside = find_member(table, "beside"))
        for (rapidjson::SizeType k = 0; k < beside->Size(); ++k) {
            std::size_t known = 0;
            for (const auto& member : (*beside)[k].GetObject())
                known += std::find(titles.begin(), titles.end(), text_of(member.name)) != titles.end() ? 1 : 0;
            if (known == 0 || known == (*beside)[k].MemberCount())
                fail_input(study.at(place + "/beside/" + std::to_string(k)),
                           known == 0 ? "names no column of the table" : "adds nothing to the columns of the table",
                           "give the titles of columns, to find the rows, and others with what stands beside them");
        }
}

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
        if (i == study.steps.size()) refuse(study, at, "there is no step '" + printable(step, 60) + "'", step, step_names(study));
        sources.push_back({i, dot == std::string::npos ? "" : text.substr(dot + 1)});
    }
    return sources;
}

void check_collected(const StudyPlan& plan) {
    const Study& study = plan.study;
    std::map<std::string, std::vector<std::string>> titles;
    std::vector<std::string> shown;
    const auto check_name = [&](const std::string& place, const std::string& name) {
        const bool plain = !name.empty() && name.size() <= 60 &&
                           std::all_of(name.begin(), name.end(),
                                       [](char c) {
                                           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                                                  c == '-' || c == '_' || c == '.';
                                       }) &&
                           name[0] != '.' && name != "page";
        if (!plain)
            fail_input(study.at(place), "cannot be the name of files", "use letters, digits, '-', '_' and '.', and not 'page'");
        if (std::find(shown.begin(), shown.end(), name) != shown.end())
            fail_input(study.at(place), "is the name of a table as well", "give the plot another name");
        shown.push_back(name);
    };
    if (const JsonValue* tables = find_member(*study.document, "tables"))
        for (const auto& member : tables->GetObject()) {
            const std::string name = text_of(member.name);
            check_name("/tables/" + name, name);
            check_table(plan, name, member.value);
            for (const auto& column : list_in(member.value, "columns")) titles[name].push_back(text_in(column, "title"));
            for (const auto& row : list_in(member.value, "beside"))
                for (const auto& one : row.GetObject()) titles[name].push_back(text_of(one.name));
        }
    if (const JsonValue* plots = find_member(*study.document, "plots"))
        for (const auto& member : plots->GetObject()) {
            const std::string name = text_of(member.name), place = "/plots/" + name, table = text_in(member.value, "table");
            check_name(place, name);
            std::vector<std::string> tables;
            for (const auto& [known, columns] : titles) tables.push_back(known);
            if (!titles.contains(table))
                refuse(study, place + "/table", "there is no table '" + printable(table, 60) + "'", table, tables);
            const auto check_column = [&](const std::string& title, const std::string& at) {
                const auto& known = titles.at(table);
                if (std::find(known.begin(), known.end(), title) == known.end())
                    refuse(study, place + "/" + at, "table '" + table + "' has no column '" + printable(title, 60) + "'", title,
                           known);
            };
            check_column(text_in(member.value, "x"), "x");
            if (const JsonValue& y = *find_member(member.value, "y"); y.IsString()) check_column(text_of(y), "y");
            else
                for (const auto& one : y.GetArray()) check_column(text_of(one), "y");
            if (find_member(member.value, "series") != nullptr) check_column(text_in(member.value, "series"), "series");
        }
    const auto sections = list_in(*study.document, "page");
    for (rapidjson::SizeType k = 0; k < sections.Size(); ++k) {
        const auto list = list_in(sections[k], "show");
        for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
            const std::string name = text_of(list[i]), place = "/page/" + std::to_string(k) + "/show/" + std::to_string(i);
            if (std::find(shown.begin(), shown.end(), name) != shown.end()) continue;
            const std::size_t dot = name.find('.');
            const std::string step = name.substr(0, dot);
            if (dot == std::string::npos || (study.step(step) == study.steps.size() && !is_left_out(study, step)))
                refuse(study, place, "there is no table, plot or output of a step '" + printable(name, 60) + "'", name, shown);
            const std::size_t s = study.step(step);
            if (s < study.steps.size() && study.steps[s].operation != nullptr &&
                !study.steps[s].keep.contains(name.substr(dot + 1)))
                fail_input(study.at(place), "'" + name + "' is not kept", "name the output in 'keep' of its step");
        }
    }
}

}  // namespace ostraka
