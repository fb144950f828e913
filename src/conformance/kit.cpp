#include "ostraka/conformance/kit.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/words.h"

#include <pugixml.hpp>

#include <algorithm>
#include <set>
#include <sstream>

namespace ostraka {

namespace {

std::vector<std::string> texts_in(const JsonValue& value, const char* member) {
    std::vector<std::string> texts;
    for (const auto& one : list_in(value, member)) texts.push_back(text_of(one));
    return texts;
}

Comparison read_comparison(const JsonValue& value) {
    Comparison comparison;
    comparison.what = text_in(value, "what");
    comparison.as = text_in(value, "as");
    comparison.within = number_or(value, "within", 0);
    if (const std::string of = text_in(value, "of"); !of.empty()) comparison.of = of;
    comparison.freedoms = texts_in(value, "freedoms");
    comparison.mesh = text_in(value, "mesh");
    comparison.only = texts_in(value, "only");
    comparison.but = texts_in(value, "but");
    comparison.reason = text_in(value, "reason");
    return comparison;
}

/// Removes members with these names from objects at any depth.
void remove_members(JsonValue& value, const std::vector<std::string>& names) {
    if (value.IsArray())
        for (auto& one : value.GetArray()) remove_members(one, names);
    if (!value.IsObject()) return;
    for (const std::string& name : names) value.RemoveMember(name);
    for (auto& member : value.GetObject()) remove_members(member.value, names);
}

Path expected_folder(const ConformanceKit& kit, const ConformanceCase& one) { return kit.folder / "expected" / one.id; }

/// File of an output, or of a file in an output folder: "output/slices.json" for the folder "slices/".
std::string file_of(const ConformanceCase& one, const std::string& what) {
    const std::size_t slash = what.find('/');
    const auto output = one.outputs.find(what.substr(0, slash));
    if (output == one.outputs.end()) return {};
    return slash == std::string::npos ? output->second : (Path(output->second) / what.substr(slash + 1)).string();
}

/// Flags common to all commands, reserved for the user who runs the kit.
constexpr const char* callers_flags[]{"json", "show", "quiet", "threads", "memory", "help"};

/// Throws unless the name lies below the case's folder, which is new and holds no links.
void require_below(const std::string& name, const std::string& where, const std::string& at) {
    require_file_name(name, where, at);
    const Path path(name);
    if (name.empty() || path.is_absolute() ||
        std::any_of(path.begin(), path.end(), [](const Path& part) { return part == ".."; }))
        fail_input(where, "at " + at + ": '" + printable(name, 100) + "' leads out of the folder of the case",
                   "give a relative name without '..'");
}

/// Names become command-line flags: throws for other text, and for flags common to all commands.
void require_setting(const std::string& name, const std::string& where, const std::string& at) {
    const bool is_plain = !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    });
    const bool is_common =
        std::any_of(std::begin(callers_flags), std::end(callers_flags), [&](const char* flag) { return name == flag; });
    if (!is_plain || is_common) fail_input(where, "at " + at + ": is no option that a case may set", "leave it out");
}

/// Throws if a positional value looks like a flag.
void require_no_flag(const JsonValue& value, const std::string& where, const std::string& at) {
    const auto begins_as_one = [](const JsonValue& one) {
        return one.IsString() && one.GetStringLength() > 1 && one.GetString()[0] == '-' && !number_of(text_of(one));
    };
    const bool is_wrong = begins_as_one(value) || (value.IsArray() && std::any_of(value.Begin(), value.End(), begins_as_one));
    if (is_wrong) fail_input(where, "at " + at + ": begins with a dash", "write it otherwise");
}

/// Checks that files of a case lie in the kit or in the folder of the case, and that it sets no reserved flags.
void check_names(const ConformanceKit& kit, const ConformanceCase& one, const Call& call, const std::string& where) {
    const std::string remedy = "put the file into the kit";
    const auto require_in_kit = [&](const std::string& name, const std::string& at) {
        static_cast<void>(file_inside(name, kit.folder, where, at, "the kit", remedy));
    };
    for (const auto& member : one.with->GetObject()) {
        const std::string name = text_of(member.name), at = "/with/" + printable(name, 60);
        require_setting(name, where, at);
        const Slot* slot = call.parameters().slot(name);
        const Option* option = slot == nullptr ? call.parameters().options.find(name) : nullptr;
        if (option != nullptr && !option->from_files)
            fail_input(where, "at " + at + ": only the caller may set it", "leave it out");
        if (option != nullptr && option->is_positional) require_no_flag(member.value, where, at);
        if (slot == nullptr) continue;
        if (slot->role == Role::output) fail_input(where, "at " + at + ": is an output", "name it in 'outputs'");
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
    for (const auto& [output, file] : one.outputs) {
        const std::string at = "/outputs/" + printable(output, 60);
        require_setting(output, where, at);
        const Slot* slot = call.parameters().slot(output);
        if ((slot != nullptr && slot->role != Role::output) || call.parameters().options.find(output) != nullptr)
            fail_input(where, "at " + at + ": is no output", "name it in 'with'");
        require_below(file, where, at);
    }
    const Path expected = Path("expected") / one.id;
    require_in_kit((expected / "report.json").string(), "/id");
    for (const Comparison& comparison : one.comparisons) {
        require_below(comparison.what, where, "/compare");
        if (!comparison.mesh.empty()) require_in_kit(comparison.mesh, "/compare/mesh");
        if (const std::string file = file_of(one, comparison.what); !file.empty())
            require_in_kit((expected / file).string(), "/compare");
    }
}

void check_case(const ConformanceKit& kit, const ConformanceCase& one, const FindOperation& find) {
    const std::string where = (kit.folder / "conformance.json").string() + ", case '" + one.id + "'";
    if (one.operation.starts_with("conformance "))
        fail_input(where, "runs a kit, which a case of a kit may not", "leave the case out");
    try {
        Call call(find(one.operation));
        check_names(kit, one, call, where);
        const Json settings = settings_of(kit, one, "/nowhere", find);
        if (one.code != 2) call.set(settings);
    } catch (const Error& error) {
        if (error.where() == where) throw;
        fail_input(where, error.problem(), error.remedy());
    }
    if ((one.code == 0 || one.code == 3) && one.comparisons.empty())
        fail_input(where, "compares nothing", "say what counts, and how far off it may be");
    for (const Comparison& comparison : one.comparisons) {
        if (comparison.what == "report" ? comparison.as != "values" : file_of(one, comparison.what).empty())
            fail_input(where, "compares '" + comparison.what + "', which is no output",
                       "name one of its outputs, or report (as values)");
        if (comparison.as == "annotations" && comparison.mesh.empty())
            fail_input(where, "compares annotations without their mesh", "name it: \"mesh\": \"FILE\" or an output");
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
        ConformanceCase one;
        one.id = text_in(value, "id");
        one.operation = text_in(value, "operation");
        one.about = text_in(value, "about");
        one.degenerate = flag_in(value, "degenerate");
        one.with = find_member(value, "with");
        if (const JsonValue* outputs = find_member(value, "outputs"))
            for (const auto& member : outputs->GetObject()) one.outputs[text_of(member.name)] = text_of(member.value);
        one.code = find_member(value, "code")->GetInt();
        one.names = texts_in(value, "names");
        for (const auto& comparison : list_in(value, "compare")) one.comparisons.push_back(read_comparison(comparison));
        if (!ids.insert(one.id).second)
            fail_input(file.string(), "case '" + one.id + "' stands there twice", "give each a name of its own");
        check_case(kit, one, find);
        kit.cases.push_back(std::move(one));
    }
    return kit;
}

Json settings_of(const ConformanceKit& kit, const ConformanceCase& one, const Path& folder, const FindOperation& find) {
    Json settings(rapidjson::kObjectType);
    auto& allocator = settings.GetAllocator();
    const Call call(find(one.operation));
    const auto named = [&](const Slot& slot, const std::string& text) {
        if (slot.takes_none && text == "none") return text;
        const std::size_t equals = slot.is_named ? text.find('=') : std::string::npos;
        if (equals == std::string::npos) return (kit.folder / text).string();
        return text.substr(0, equals + 1) + (kit.folder / text.substr(equals + 1)).string();
    };
    for (const auto& member : one.with->GetObject()) {
        const std::string name = text_of(member.name);
        const Slot* slot = call.parameters().slot(name);
        JsonValue value(member.value, allocator);
        if (slot != nullptr && value.IsString()) {
            value = json_string(named(*slot, text_of(member.value)), allocator);
        } else if (slot != nullptr && value.IsArray()) {
            for (auto& file : value.GetArray())
                if (file.IsString()) file = json_string(named(*slot, text_of(file)), allocator);
        }
        add_member(settings, name, std::move(value), allocator);
    }
    for (const auto& [output, file] : one.outputs) add_member(settings, output, (folder / file).string(), allocator);
    // Without a named folder, a run would write into the current folder.
    if (one.operation == "run" && !one.outputs.contains("output"))
        add_member(settings, "output", (folder / "unnamed-run").string(), allocator);
    return settings;
}

namespace {
Answer answer_of(const ConformanceKit& kit, const ConformanceCase& one, Backend& backend, const Path& folder,
                 const FindOperation& find) {
    std::error_code code;
    std::filesystem::remove_all(folder, code);
    make_folder(folder);
    for (const auto& [output, file] : one.outputs)
        if (file.ends_with('/')) make_folder(folder / file);
    return backend.run(one, settings_of(kit, one, folder, find), folder);
}
}  // namespace

CaseResult run_case(const ConformanceKit& kit, const ConformanceCase& one, Backend& backend, const Path& scratch,
                    const FindOperation& find) {
    const Path folder = std::filesystem::absolute(scratch / one.id), expected = expected_folder(kit, one);
    const Answer answer = answer_of(kit, one, backend, folder, find);
    CaseResult result;
    result.seconds = answer.seconds;
    if (answer.code == 4) {
        result.outcome = Outcome::unsupported;
        return result;
    }
    if (answer.code != one.code) {
        result.differences.push_back("exit code " + std::to_string(answer.code) + ", expected " + std::to_string(one.code) +
                                     (answer.message.empty() ? "" : ": " + answer.message));
        return result;
    }
    for (const std::string& word : one.names)
        if (answer.message.find(word) == std::string::npos)
            result.differences.push_back("the message does not name '" + word + "': " + answer.message);
    for (const Comparison& comparison : one.comparisons) {
        std::string how;
        if (comparison.what == "report") {
            const Json wanted = read_json(expected / "report.json");
            how = answer.result ? difference_of_values(comparison, wanted, *answer.result)
                                : "there is none" + (answer.message.empty() ? "" : ": " + answer.message);
        } else {
            const std::string file = file_of(one, comparison.what), mesh = file_of(one, comparison.mesh);
            how = difference(comparison, expected / file, folder / file,
                             mesh.empty() ? kit.folder / comparison.mesh : expected / mesh,
                             mesh.empty() ? kit.folder / comparison.mesh : folder / mesh);
        }
        if (!how.empty()) result.differences.push_back(comparison.what + ": " + how);
    }
    if (result.differences.empty()) result.outcome = Outcome::agrees;
    return result;
}

void record_case(const ConformanceKit& kit, const ConformanceCase& one, Backend& backend, const Path& scratch,
                 const FindOperation& find) {
    const Path folder = std::filesystem::absolute(scratch / one.id), expected = expected_folder(kit, one);
    const Answer answer = answer_of(kit, one, backend, folder, find);
    if (answer.code != one.code)
        fail_work("case '" + one.id + "'",
                  "exit code " + std::to_string(answer.code) + ", expected " + std::to_string(one.code) + ": " + answer.message,
                  "correct the case, or what it tests");
    for (const std::string& word : one.names)
        if (answer.message.find(word) == std::string::npos)
            fail_work("case '" + one.id + "'", "the message does not name '" + word + "': " + answer.message, "correct the case");
    std::error_code code;
    std::filesystem::remove_all(expected, code);
    std::set<std::string> files;
    Json report(rapidjson::kObjectType);  // only compared members: others may contain local paths
    for (const Comparison& comparison : one.comparisons) {
        if (comparison.what == "report") {
            if (!answer.result) fail_work("case '" + one.id + "'", "there is no report", "correct the case");
            for (const std::string& name : comparison.only)
                if (find_member(*answer.result, name) == nullptr)
                    fail_work("case '" + one.id + "'", "compares '" + name + "', which the report does not have",
                              "correct the case");
            for (const auto& member : answer.result->GetObject()) {
                const std::string name = text_of(member.name);
                const auto in = [&](const std::vector<std::string>& names) {
                    return std::find(names.begin(), names.end(), name) != names.end();
                };
                if ((comparison.only.empty() || in(comparison.only)) && !in(comparison.but) &&
                    find_member(report, name) == nullptr) {
                    JsonValue value(member.value, report.GetAllocator());
                    remove_members(value, comparison.but);
                    add_members(report, report.GetAllocator(), name, std::move(value));
                }
            }
        } else if (comparison.as != "exists") {
            files.insert(file_of(one, comparison.what));
            if (const std::string mesh = file_of(one, comparison.mesh); !mesh.empty()) files.insert(mesh);
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
    set(suite, "name", "ostraka conformance " + kit.version + ": " + backend);
    set(suite, "tests", std::to_string(results.size()));
    set(suite, "failures", std::to_string(failed));
    set(suite, "skipped", std::to_string(skipped));
    set(suite, "time", digits(seconds, 6));
    for (std::size_t i = 0; i < results.size(); ++i) {
        pugi::xml_node one = suite.append_child("testcase");
        set(one, "classname", kit.cases[i].operation);
        set(one, "name", kit.cases[i].id);
        set(one, "time", digits(results[i].seconds, 6));
        if (results[i].outcome == Outcome::unsupported) one.append_child("skipped");
        if (results[i].outcome == Outcome::differs)
            set(one.append_child("failure"), "message", joined(results[i].differences, "; "));
    }
    std::ostringstream text;
    document.save(text, " ");
    return text.str();
}

}  // namespace ostraka
