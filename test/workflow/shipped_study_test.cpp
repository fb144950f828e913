// The studies that come with the toolkit: all that they compute is shown.
#include "studies.h"

#include "ostraka/core/json.h"

#include <filesystem>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const Path shipped = Path(OSTRAKA_SOURCE_DIR) / "data";

/// All texts in a value, also the names of its members.
void collect_texts(const JsonValue& value, std::vector<std::string>& texts) {
    if (value.IsString()) texts.push_back(text_of(value));
    if (value.IsArray())
        for (const auto& one : value.GetArray()) collect_texts(one, texts);
    if (value.IsObject())
        for (const auto& member : value.GetObject()) collect_texts(member.value, texts);
}

std::vector<std::string> texts_of(const JsonValue& study, const char* member) {
    std::vector<std::string> texts;
    if (const JsonValue* part = find_member(study, member)) collect_texts(*part, texts);
    return texts;
}

/// What a text `PREFIX NAME . REST` or `PREFIX NAME` names.
bool names(const std::string& text, const std::string& name) { return text == name || text.starts_with(name + "."); }

/// What is computed and goes nowhere: steps, parameters, tables and plots.
std::vector<std::string> left_over(const JsonValue& study) {
    std::vector<std::string> shown, steps = texts_of(study, "steps"), left;
    if (const JsonValue* page = find_member(study, "page"))
        for (const auto& section : page->GetArray())
            for (const auto& one : list_in(section, "show")) shown.push_back(text_of(one));
    const bool all_shown = shown.empty();
    const auto is_shown = [&](const std::string& name) {
        return all_shown || std::any_of(shown.begin(), shown.end(), [&](const std::string& one) { return names(one, name); });
    };
    std::vector<std::string> rows, plotted;
    for (const char* member : {"tables", "plots"})
        if (const JsonValue* list = find_member(study, member))
            for (const auto& one : list->GetObject()) {
                if (const JsonValue* from = find_member(one.value, "rows")) collect_texts(*from, rows);
                if (find_member(one.value, "table") != nullptr) plotted.push_back(text_in(one.value, "table"));
            }
    const auto any = [](const std::vector<std::string>& texts, const auto& holds) {
        return std::any_of(texts.begin(), texts.end(), holds);
    };
    for (const auto& step : find_member(study, "steps")->GetObject()) {
        const std::string name = text_of(step.name);
        const auto taken = [&](const std::string& text) {
            return text.find("${" + name + ".") != std::string::npos || text.starts_with(name + ".");
        };
        const auto listed = [&](const std::string& text) { return names(text, name); };
        if (!any(steps, taken) && !any(rows, listed) && !any(shown, listed)) left.push_back("step " + name);
    }
    for (const auto& table : find_member(study, "tables")->GetObject())
        if (const std::string name = text_of(table.name);
            !is_shown(name) && !any(plotted, [&](const std::string& one) { return one == name; }))
            left.push_back("table " + name);
    if (const JsonValue* plots = find_member(study, "plots"))
        for (const auto& plot : plots->GetObject())
            if (!is_shown(text_of(plot.name))) left.push_back("plot " + text_of(plot.name));
    std::vector<std::string> tables = texts_of(study, "tables");
    steps.insert(steps.end(), tables.begin(), tables.end());
    if (const JsonValue* parameters = find_member(study, "parameters"))
        for (const auto& parameter : parameters->GetObject()) {
            const std::string name = "${" + text_of(parameter.name);
            if (!any(steps, [&](const std::string& text) {
                    return text.find(name + "}") != std::string::npos || text.find(name + ".") != std::string::npos;
                }))
                left.push_back("parameter " + text_of(parameter.name));
        }
    return left;
}

}  // namespace

TEST(ShippedStudies, ComputeNothingThatIsShownNowhere) {
    int studies = 0;
    for (const auto& entry : std::filesystem::directory_iterator(shipped)) {
        if (!entry.path().string().ends_with(".study.json")) continue;
        const Json study = read_json(entry.path());
        if (find_member(study, "steps") == nullptr) continue;  // a list of objects
        ++studies;
        for (const std::string& name : left_over(study)) ADD_FAILURE() << entry.path() << ": " << name << " is shown nowhere";
    }
    EXPECT_GE(studies, 3);
}

TEST(ShippedStudies, WhatIsLeftOverIsFound) {
    Json study;
    study.Parse(R"({"parameters": {"used": 1, "unused": 2},
        "steps": {"a": {"operation": "mesh make", "with": {"vertices": "${used}"}},
                  "b": {"operation": "mesh info", "with": {"input": "${a.output}"}}, "lonely": {"operation": "mesh make"}},
        "tables": {"t": {"rows": "b", "columns": []}, "hidden": {"rows": "b", "columns": []}},
        "page": [{"show": ["t"]}]})");
    EXPECT_EQ(left_over(study), (std::vector<std::string>{"step lonely", "table hidden", "parameter unused"}));
}

TEST(ShippedStudies, TheThesisStandsBesideEachTable) {
    const Json study = read_json(shipped / "thesis.study.json");
    for (const auto& table : find_member(study, "tables")->GetObject()) {
        const std::string note = text_in(table.value, "note");
        EXPECT_TRUE(note.starts_with("Thesis: ")) << text_of(table.name);
        EXPECT_NE(note.find(" Differs: "), std::string::npos) << text_of(table.name);
    }
}
