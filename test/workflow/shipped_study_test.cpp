// The shipped studies: all their results are shown.
#include "studies.h"

#include "ostraka/files/json.h"

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
        for (const auto& element : value.GetArray()) collect_texts(element, texts);
    if (value.IsObject())
        for (const auto& member : value.GetObject()) collect_texts(member.value, texts);
}

std::vector<std::string> texts_of(const JsonValue& study, const char* member) {
    std::vector<std::string> texts;
    if (const JsonValue* part = find_member(study, member)) collect_texts(*part, texts);
    return texts;
}

/// The name in a text `PREFIX NAME . REST` or `PREFIX NAME`.
bool names(const std::string& text, const std::string& name) { return text == name || text.starts_with(name + "."); }

/// Unused steps, parameters, tables and plots.
std::vector<std::string> left_over(const JsonValue& study) {
    std::vector<std::string> shown_names, steps = texts_of(study, "steps"), unused;
    if (const JsonValue* page = find_member(study, "page"))
        for (const auto& section : page->GetArray())
            for (const auto& shown_name : list_in(section, "show")) shown_names.push_back(text_of(shown_name));
    const bool all_shown = shown_names.empty();
    const auto is_shown = [&](const std::string& name) {
        return all_shown || std::any_of(shown_names.begin(), shown_names.end(),
                                        [&](const std::string& shown_name) { return names(shown_name, name); });
    };
    std::vector<std::string> rows, plotted;
    for (const char* member : {"tables", "plots"})
        if (const JsonValue* descriptions = find_member(study, member))
            for (const auto& description : descriptions->GetObject()) {
                if (const JsonValue* row_source = find_member(description.value, "rows")) collect_texts(*row_source, rows);
                if (find_member(description.value, "table") != nullptr) plotted.push_back(text_in(description.value, "table"));
            }
    const auto any = [](const std::vector<std::string>& texts, const auto& condition) {
        return std::any_of(texts.begin(), texts.end(), condition);
    };
    for (const auto& step : find_member(study, "steps")->GetObject()) {
        const std::string name = text_of(step.name);
        const auto is_output_used = [&](const std::string& text) {
            return text.find("${" + name + ".") != std::string::npos || text.starts_with(name + ".");
        };
        const auto listed = [&](const std::string& text) { return names(text, name); };
        if (!any(steps, is_output_used) && !any(rows, listed) && !any(shown_names, listed)) unused.push_back("step " + name);
    }
    for (const auto& table : find_member(study, "tables")->GetObject())
        if (const std::string name = text_of(table.name);
            !is_shown(name) && !any(plotted, [&](const std::string& plotted_table) { return plotted_table == name; }))
            unused.push_back("table " + name);
    if (const JsonValue* plots = find_member(study, "plots"))
        for (const auto& plot : plots->GetObject())
            if (!is_shown(text_of(plot.name))) unused.push_back("plot " + text_of(plot.name));
    std::vector<std::string> tables = texts_of(study, "tables");
    steps.insert(steps.end(), tables.begin(), tables.end());
    if (const JsonValue* parameters = find_member(study, "parameters"))
        for (const auto& parameter : parameters->GetObject()) {
            const std::string name = "${" + text_of(parameter.name);
            if (!any(steps, [&](const std::string& text) {
                    return text.find(name + "}") != std::string::npos || text.find(name + ".") != std::string::npos;
                }))
                unused.push_back("parameter " + text_of(parameter.name));
        }
    return unused;
}

}  // namespace

TEST(ShippedStudies, ShowAllTheirResults) {
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

TEST(ShippedStudies, UnusedPartsAreReported) {
    Json study;
    study.Parse(R"({"parameters": {"used": 1, "unused": 2},
        "steps": {"a": {"operation": "mesh make", "with": {"vertices": "${used}"}},
                  "b": {"operation": "mesh info", "with": {"input": "${a.output}"}}, "lonely": {"operation": "mesh make"}},
        "tables": {"t": {"rows": "b", "columns": []}, "hidden": {"rows": "b", "columns": []}},
        "page": [{"show": ["t"]}]})");
    EXPECT_EQ(left_over(study), (std::vector<std::string>{"step lonely", "table hidden", "parameter unused"}));
}

TEST(ShippedStudies, EachTableNotesTheThesisValues) {
    const Json study = read_json(shipped / "thesis.study.json");
    for (const auto& table : find_member(study, "tables")->GetObject()) {
        const std::string note = text_in(table.value, "note");
        EXPECT_TRUE(note.starts_with("Thesis: ")) << text_of(table.name);
        EXPECT_NE(note.find(" Differs: "), std::string::npos) << text_of(table.name);
    }
}
