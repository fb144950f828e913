#include "ostraka/conformance/kit.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>
#include <pugixml.hpp>

#include <algorithm>
#include <set>
#include <sstream>

namespace ostraka {

namespace {

std::vector<std::string> texts_in(const JsonValue& value, const char* member) {
    std::vector<std::string> texts;
    for (const auto& element : list_in(value, member)) texts.push_back(text_of(element));
    return texts;
}

Comparison read_comparison(const JsonValue& value) {
    Comparison comparison;
    comparison.output = text_in(value, "what");
    comparison.method = text_in(value, "as");
    comparison.tolerance = number_or(value, "within", 0);
    if (const std::string scale = text_in(value, "of"); !scale.empty()) comparison.scale = scale;
    comparison.permitted_differences = texts_in(value, "freedoms");
    comparison.mesh = text_in(value, "mesh");
    comparison.only = texts_in(value, "only");
    comparison.ignored = texts_in(value, "but");
    comparison.reason = text_in(value, "reason");
    return comparison;
}

/// Removes members with these names from objects at any depth.
void remove_members(JsonValue& value, const std::vector<std::string>& names) {
    if (value.IsArray())
        for (auto& element : value.GetArray()) remove_members(element, names);
    if (!value.IsObject()) return;
    for (const std::string& name : names) value.RemoveMember(name);
    for (auto& member : value.GetObject()) remove_members(member.value, names);
}

Path expected_folder(const ConformanceKit& kit, const ConformanceCase& test_case) {
    return kit.folder / "expected" / test_case.id;
}

/// File of an output, or of a file in an output folder: "output/slices.json" for the folder "slices/".
std::string file_of(const ConformanceCase& test_case, const std::string& output_name) {
    const std::size_t slash = output_name.find('/');
    const auto output = test_case.outputs.find(output_name.substr(0, slash));
    if (output == test_case.outputs.end()) return {};
    return slash == std::string::npos ? output->second : (Path(output->second) / output_name.substr(slash + 1)).string();
}

/// Flags common to all commands, reserved for the user who runs the kit.
constexpr const char* reserved_flags[]{"json", "show", "quiet", "threads", "memory", "help"};

/// Throws unless the name lies below the case's folder, which is new and holds no links.
void require_below(const std::string& name, const std::string& where, const std::string& at) {
    require_file_name(name, where, at);
    const Path path(name);
    if (name.empty() || path.is_absolute() ||
        std::any_of(path.begin(), path.end(), [](const Path& part) { return part == ".."; }))
        fail_input(where, fmt::format("at {}: '{}' leads out of the folder of the case", at, printable(name, 100)),
                   "give a relative name without '..'");
}

/// Names become command-line flags: throws for other text, and for flags common to all commands.
void require_setting(const std::string& name, const std::string& where, const std::string& at) {
    const bool is_plain = !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    });
    const bool is_common =
        std::any_of(std::begin(reserved_flags), std::end(reserved_flags), [&](const char* flag) { return name == flag; });
    if (!is_plain || is_common) fail_input(where, fmt::format("at {}: is not an option that a case may set", at), "remove it");
}

/// Throws if a positional value looks like a flag.
void require_no_flag(const JsonValue& value, const std::string& where, const std::string& at) {
    const auto looks_like_flag = [](const JsonValue& element) {
        return element.IsString() && element.GetStringLength() > 1 && element.GetString()[0] == '-' &&
               !number_of(text_of(element));
    };
    const bool is_wrong = looks_like_flag(value) || (value.IsArray() && std::any_of(value.Begin(), value.End(), looks_like_flag));
    if (is_wrong) fail_input(where, fmt::format("at {}: begins with a dash", at), "write it without a leading dash");
}

/// Checks that files of a case lie in the kit or in the folder of the case, and that it sets no reserved flags.
void check_names(const ConformanceKit& kit, const ConformanceCase& test_case, const Call& call, const std::string& where) {
    const std::string remedy = "put the file into the kit";
    const auto require_in_kit = [&](const std::string& name, const std::string& at) {
        static_cast<void>(file_inside(name, kit.folder, where, at, "the kit", remedy));
    };
    for (const auto& member : test_case.with->GetObject()) {
        const std::string name = text_of(member.name), at = "/with/" + printable(name, 60);
        require_setting(name, where, at);
        const Slot* slot = call.parameters().slot(name);
        const Option* option = slot == nullptr ? call.parameters().options.find(name) : nullptr;
        if (option != nullptr && !option->from_files)
            fail_input(where, fmt::format("at {}: can be set only by the caller", at), "remove it");
        if (option != nullptr && option->is_positional) require_no_flag(member.value, where, at);
        if (slot == nullptr) continue;
        if (slot->role == Role::output) fail_input(where, fmt::format("at {}: is an output", at), "list it in 'outputs'");
        const auto check = [&](const JsonValue& value) {
            if (!value.IsString()) return;
            std::string file = text_of(value);
            if (slot->takes_none && file == "none") return;
            if (const std::size_t equals = slot->is_named ? file.find('=') : std::string::npos; equals != std::string::npos)
                file = file.substr(equals + 1);
            require_in_kit(file.empty() ? "." : file, at);
        };
        check(member.value);
        if (member.value.IsArray())
            for (const auto& value : member.value.GetArray()) check(value);
    }
    for (const auto& [output, file] : test_case.outputs) {
        const std::string at = "/outputs/" + printable(output, 60);
        require_setting(output, where, at);
        const Slot* slot = call.parameters().slot(output);
        if ((slot != nullptr && slot->role != Role::output) || call.parameters().options.find(output) != nullptr)
            fail_input(where, fmt::format("at {}: is not an output", at), "set it in 'with'");
        require_below(file, where, at);
    }
    const Path expected = Path("expected") / test_case.id;
    require_in_kit((expected / "report.json").string(), "/id");
    for (const Comparison& comparison : test_case.comparisons) {
        require_below(comparison.output, where, "/compare");
        if (!comparison.mesh.empty()) require_in_kit(comparison.mesh, "/compare/mesh");
        if (const std::string file = file_of(test_case, comparison.output); !file.empty())
            require_in_kit((expected / file).string(), "/compare");
    }
}

void check_case(const ConformanceKit& kit, const ConformanceCase& test_case, const FindOperation& find) {
    const std::string where = fmt::format("{}, case '{}'", (kit.folder / "conformance.json").string(), test_case.id);
    if (test_case.operation.starts_with("conformance "))
        fail_input(where, "runs a conformance kit, which is not allowed in a case", "remove the case");
    try {
        Call call(find(test_case.operation));
        check_names(kit, test_case, call, where);
        const Json settings = settings_of(kit, test_case, "/nowhere", find);
        if (test_case.code != 2) call.set(settings);
    } catch (const Error& error) {
        if (error.where() == where) throw;
        fail_input(where, error.problem(), error.remedy());
    }
    if ((test_case.code == 0 || test_case.code == 3) && test_case.comparisons.empty())
        fail_input(where, "has no comparisons", "list what is compared, and the tolerances");
    for (const Comparison& comparison : test_case.comparisons) {
        if (comparison.output == "report" ? comparison.method != "values" : file_of(test_case, comparison.output).empty())
            fail_input(where, fmt::format("compares '{}', which is not an output", comparison.output),
                       "name one of its outputs, or report (as values)");
        if (comparison.method == "annotations" && comparison.mesh.empty())
            fail_input(where, "compares annotations without their mesh", "give \"mesh\": \"FILE\" or the name of an output");
    }
}

}  // namespace

std::string to_string(Outcome outcome) {
    static constexpr const char* names[]{"agrees", "differs", "unsupported"};
    return names[static_cast<std::size_t>(outcome)];
}

ConformanceKit read_kit(const Path& folder, const FindOperation& find) {
    const Path file = folder / "conformance.json";
    ConformanceKit kit;
    kit.folder = std::filesystem::absolute(folder).lexically_normal();
    kit.document = std::make_shared<const Json>(read_json(file));
    check_format(*kit.document, "ostraka-conformance", file.string(), "name the folder of a conformance kit");
    validate(*kit.document, "conformance", file.string());
    kit.version = text_in(*kit.document, "kit");
    std::set<std::string> ids;
    for (const auto& value : list_in(*kit.document, "cases")) {
        ConformanceCase test_case;
        test_case.id = text_in(value, "id");
        test_case.operation = text_in(value, "operation");
        test_case.about = text_in(value, "about");
        test_case.degenerate = flag_in(value, "degenerate");
        test_case.with = find_member(value, "with");
        if (const JsonValue* outputs = find_member(value, "outputs"))
            for (const auto& member : outputs->GetObject()) test_case.outputs[text_of(member.name)] = text_of(member.value);
        test_case.code = find_member(value, "code")->GetInt();
        test_case.names = texts_in(value, "names");
        for (const auto& comparison : list_in(value, "compare")) test_case.comparisons.push_back(read_comparison(comparison));
        if (!ids.insert(test_case.id).second)
            fail_input(file.string(), fmt::format("two cases have the id '{}'", test_case.id), "give each case its own id");
        check_case(kit, test_case, find);
        kit.cases.push_back(std::move(test_case));
    }
    return kit;
}

Json settings_of(const ConformanceKit& kit, const ConformanceCase& test_case, const Path& folder, const FindOperation& find) {
    Json settings(rapidjson::kObjectType);
    auto& allocator = settings.GetAllocator();
    const Call call(find(test_case.operation));
    const auto file_argument = [&](const Slot& slot, const std::string& text) {
        if (slot.takes_none && text == "none") return text;
        const std::size_t equals = slot.is_named ? text.find('=') : std::string::npos;
        if (equals == std::string::npos) return (kit.folder / text).string();
        return text.substr(0, equals + 1) + (kit.folder / text.substr(equals + 1)).string();
    };
    for (const auto& member : test_case.with->GetObject()) {
        const std::string name = text_of(member.name);
        const Slot* slot = call.parameters().slot(name);
        JsonValue value(member.value, allocator);
        if (slot != nullptr && value.IsString()) {
            value = json_string(file_argument(*slot, text_of(member.value)), allocator);
        } else if (slot != nullptr && value.IsArray()) {
            for (auto& file : value.GetArray())
                if (file.IsString()) file = json_string(file_argument(*slot, text_of(file)), allocator);
        }
        add_member(settings, name, std::move(value), allocator);
    }
    for (const auto& [output, file] : test_case.outputs) add_member(settings, output, (folder / file).string(), allocator);
    // Without a named folder, a run would write into the current folder.
    if (test_case.operation == "run" && !test_case.outputs.contains("output"))
        add_member(settings, "output", (folder / "unnamed-run").string(), allocator);
    return settings;
}

namespace {
Answer answer_of(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& folder,
                 const FindOperation& find) {
    std::error_code code;
    std::filesystem::remove_all(folder, code);
    make_folder(folder);
    for (const auto& [output, file] : test_case.outputs)
        if (file.ends_with('/')) make_folder(folder / file);
    return backend.run(test_case, settings_of(kit, test_case, folder, find), folder);
}
}  // namespace

CaseResult run_case(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& scratch,
                    const FindOperation& find) {
    const Path folder = std::filesystem::absolute(scratch / test_case.id), expected = expected_folder(kit, test_case);
    const Answer answer = answer_of(kit, test_case, backend, folder, find);
    CaseResult result;
    result.seconds = answer.seconds;
    if (answer.code == 4) {
        result.outcome = Outcome::unsupported;
        return result;
    }
    if (answer.code != test_case.code) {
        result.differences.push_back(fmt::format("exit code {}, expected {}{}", answer.code, test_case.code,
                                                 answer.message.empty() ? "" : ": " + answer.message));
        return result;
    }
    for (const std::string& word : test_case.names)
        if (answer.message.find(word) == std::string::npos)
            result.differences.push_back(fmt::format("the message does not contain '{}': {}", word, answer.message));
    for (const Comparison& comparison : test_case.comparisons) {
        std::string difference_text;
        if (comparison.output == "report") {
            const Json expected_report = read_json(expected / "report.json");
            difference_text = answer.result ? difference_of_values(comparison, expected_report, *answer.result)
                                            : "there is no report" + (answer.message.empty() ? "" : ": " + answer.message);
        } else {
            const std::string file = file_of(test_case, comparison.output), mesh = file_of(test_case, comparison.mesh);
            difference_text = difference(comparison, expected / file, folder / file,
                                         mesh.empty() ? kit.folder / comparison.mesh : expected / mesh,
                                         mesh.empty() ? kit.folder / comparison.mesh : folder / mesh);
        }
        if (!difference_text.empty()) result.differences.push_back(fmt::format("{}: {}", comparison.output, difference_text));
    }
    if (result.differences.empty()) result.outcome = Outcome::agrees;
    return result;
}

void record_case(const ConformanceKit& kit, const ConformanceCase& test_case, Backend& backend, const Path& scratch,
                 const FindOperation& find) {
    const Path folder = std::filesystem::absolute(scratch / test_case.id), expected = expected_folder(kit, test_case);
    const Answer answer = answer_of(kit, test_case, backend, folder, find);
    if (answer.code != test_case.code)
        fail_work(fmt::format("case '{}'", test_case.id),
                  fmt::format("exit code {}, expected {}: {}", answer.code, test_case.code, answer.message),
                  "correct the case, or the operation that it tests");
    for (const std::string& word : test_case.names)
        if (answer.message.find(word) == std::string::npos)
            fail_work(fmt::format("case '{}'", test_case.id),
                      fmt::format("the message does not contain '{}': {}", word, answer.message), "correct the case");
    std::error_code code;
    std::filesystem::remove_all(expected, code);
    std::set<std::string> files;
    Json report(rapidjson::kObjectType);  // only compared members: others may contain local paths
    for (const Comparison& comparison : test_case.comparisons) {
        if (comparison.output == "report") {
            if (!answer.result) fail_work(fmt::format("case '{}'", test_case.id), "there is no report", "correct the case");
            for (const std::string& name : comparison.only)
                if (find_member(*answer.result, name) == nullptr)
                    fail_work(fmt::format("case '{}'", test_case.id),
                              fmt::format("compares '{}', which the report does not have", name), "correct the case");
            for (const auto& member : answer.result->GetObject()) {
                const std::string name = text_of(member.name);
                const auto in = [&](const std::vector<std::string>& names) {
                    return std::find(names.begin(), names.end(), name) != names.end();
                };
                if ((comparison.only.empty() || in(comparison.only)) && !in(comparison.ignored) &&
                    find_member(report, name) == nullptr) {
                    JsonValue value(member.value, report.GetAllocator());
                    remove_members(value, comparison.ignored);
                    add_members(report, report.GetAllocator(), name, std::move(value));
                }
            }
        } else if (comparison.method != "exists") {
            files.insert(file_of(test_case, comparison.output));
            if (const std::string mesh = file_of(test_case, comparison.mesh); !mesh.empty()) files.insert(mesh);
        }
    }
    if (report.MemberCount() > 0) {
        make_folder(expected);
        write_json(expected / "report.json", report);
    }
    for (const std::string& file : files) {
        make_folder((expected / file).parent_path());
        write_file(expected / file, read_file(folder / file));
    }
}

std::string junit_of(const ConformanceKit& kit, const std::vector<CaseResult>& results, const std::string& backend) {
    std::size_t failed = 0, skipped = 0;
    double seconds = 0;
    for (const CaseResult& result : results) {
        failed += result.outcome == Outcome::differs ? 1 : 0;
        skipped += result.outcome == Outcome::unsupported ? 1 : 0;
        seconds += result.seconds;
    }
    pugi::xml_document document;
    pugi::xml_node suite = document.append_child("testsuites").append_child("testsuite");
    const auto set = [](pugi::xml_node node, const char* name, const std::string& value) {
        node.append_attribute(name) = without_controls(value, " ").c_str();
    };
    set(suite, "name", fmt::format("ostraka conformance {}: {}", kit.version, backend));
    set(suite, "tests", std::to_string(results.size()));
    set(suite, "failures", std::to_string(failed));
    set(suite, "skipped", std::to_string(skipped));
    set(suite, "time", digits(seconds, 6));
    for (std::size_t i = 0; i < results.size(); ++i) {
        pugi::xml_node case_node = suite.append_child("testcase");
        set(case_node, "classname", kit.cases[i].operation);
        set(case_node, "name", kit.cases[i].id);
        set(case_node, "time", digits(results[i].seconds, 6));
        if (results[i].outcome == Outcome::unsupported) case_node.append_child("skipped");
        if (results[i].outcome == Outcome::differs)
            set(case_node.append_child("failure"), "message", joined(results[i].differences, "; "));
    }
    std::ostringstream text;
    document.save(text, " ");
    return text.str();
}

}  // namespace ostraka
