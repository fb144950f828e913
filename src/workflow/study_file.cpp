#include "ostraka/workflow/study_file.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/safe_path.h"
#include "workflow/file_pattern.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <set>

namespace ostraka {

namespace {

constexpr const char* name_rule = "letters, digits, '-' and '_', beginning with a letter";
constexpr std::int64_t maximum_values = 100'000;

bool is_name(const std::string& name) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return !name.empty() && name.size() <= 60 && is_letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_';
    });
}

/// Names of places to which words of programs may refer.
bool is_reserved(const std::string& name) { return name == "folder" || name == "study"; }

/// A reference token of a JSON pointer (RFC 6901).
std::string pointer_word(const std::string& name) {
    std::string text;
    for (const char c : printable(name, 60))
        if (c == '~') text += "~0";
        else if (c == '/') text += "~1";
        else text += c;
    return text;
}

std::shared_ptr<const Json> copy_of(const JsonValue& value) {
    auto copy = std::make_shared<Json>();
    copy->CopyFrom(value, copy->GetAllocator());
    return copy;
}
std::shared_ptr<const Json> text_value(const std::string& text) {
    auto copy = std::make_shared<Json>();
    copy->SetString(text, copy->GetAllocator());
    return copy;
}

ParameterValue scalar_value(const JsonValue& value) { return {{{"", copy_of(value)}}, scalar_text(value)}; }

ParameterValue case_value(const JsonValue& value, std::size_t number) {
    ParameterValue parameter_value;
    for (const auto& member : value.GetObject()) parameter_value.members[text_of(member.name)] = copy_of(member.value);
    const auto name = parameter_value.members.find("name");
    parameter_value.label = name == parameter_value.members.end() ? std::to_string(number + 1) : scalar_text(*name->second);
    parameter_value.members[""] = text_value(parameter_value.label);
    return parameter_value;
}

/// The file relative to the study's folder, like all other files of the study.
ParameterValue file_value(const Study& study, const Path& matching_file) {
    const Path file = study.relative(matching_file);
    ParameterValue parameter_value;
    parameter_value.label = file.stem().string();
    parameter_value.members[""] = text_value(file.string());
    parameter_value.members["name"] = text_value(file.filename().string());
    parameter_value.members["stem"] = text_value(file.stem().string());
    parameter_value.members["folder"] = text_value(file.parent_path().string());
    return parameter_value;
}

StudyParameter read_parameter(const Study& study, const std::string& name, const JsonValue& value, const std::string& place) {
    StudyParameter parameter{name, {}, false, true};
    if (!is_name(name) || is_reserved(name))
        fail_input(study.at(place), "is not a valid name of a parameter",
                   fmt::format("use {}; 'folder' and 'study' are reserved", name_rule));
    if (value.IsArray()) {
        for (const auto& element : value.GetArray())
            parameter.values.push_back(element.IsObject() ? case_value(element, parameter.values.size()) : scalar_value(element));
    } else if (value.IsObject() && find_member(value, "files") != nullptr) {
        const Path pattern = (study.folder / text_in(value, "files")).lexically_normal();
        study.require_readable(before_wildcards(pattern), place + "/files");
        for (const Path& file :
             matching_files(pattern, [&](const Path& folder) { return is_inside_any(folder, study.readable); })) {
            study.require_readable(file, place + "/files");
            parameter.values.push_back(file_value(study, file));
        }
        if (parameter.values.empty())
            fail_input(study.at(place + "/files"), fmt::format("no file matches '{}'", pattern.string()),
                       "names are relative to the study file; * matches any characters, ? matches one");
    } else if (value.IsObject()) {
        const std::int64_t from = find_member(value, "from")->GetInt64(), to = find_member(value, "to")->GetInt64();
        const JsonValue* step_value = find_member(value, "step");
        const std::int64_t step = step_value == nullptr ? 1 : step_value->GetInt64();
        if (to < from) fail_input(study.at(place), "ends before it begins", "give a value of 'to' that is not below 'from'");
        const std::int64_t last = (to - from) / step;  // the schema's bounds prevent overflow
        if (last >= maximum_values)
            fail_input(study.at(place), fmt::format("has more than {} values", maximum_values), "give fewer");
        for (std::int64_t i = 0; i <= last; ++i)
            parameter.values.push_back(scalar_value(Json(rapidjson::kNullType).SetInt64(from + i * step)));
    } else {
        parameter.values.push_back(scalar_value(value));
        parameter.varies = false;
    }
    std::set<std::string> labels;
    for (const auto& parameter_value : parameter.values)
        if (!labels.insert(parameter_value.label).second)
            fail_input(study.at(place), fmt::format("contains '{}' twice", printable(parameter_value.label, 60)),
                       "give each value once");
    return parameter;
}

/// Converts "NAME=VALUE,VALUE" of the command line to the form of the file.
std::pair<std::string, Json> parse_set_option(const std::string& word) {
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == word.size())
        fail_usage(fmt::format("--set '{}' is not of the form NAME=VALUE", printable(word, 60)),
                   "give NAME=VALUE, or NAME=VALUE,VALUE");
    const std::string text = word.substr(equals + 1);
    Json value;
    const auto parsed_value = [&](const std::string& part) {
        JsonValue json_value;
        if (part == "true" || part == "false") json_value.SetBool(part == "true");
        else if (const auto number = number_of(part)) {
            if (*number == std::floor(*number) && std::abs(*number) < 1e15)
                json_value.SetInt64(static_cast<std::int64_t>(*number));
            else json_value.SetDouble(*number);
        } else json_value = json_string(part, value.GetAllocator());
        return json_value;
    };
    if (text.find(',') == std::string::npos) {
        static_cast<JsonValue&>(value) = parsed_value(text);
    } else {
        value.SetArray();
        std::size_t begin = 0;
        for (std::size_t at = 0; at <= text.size(); ++at)
            if (at == text.size() || text[at] == ',') {
                value.PushBack(parsed_value(text.substr(begin, at - begin)), value.GetAllocator());
                begin = at + 1;
            }
    }
    return {word.substr(0, equals), std::move(value)};
}

class StudyReader {
public:
    StudyReader(Study& study, const FindOperation& find) : study_(study), find_(find) {}

    void read(const StudyOptions& options) {
        const Json& document = *study_.document;
        validate(
            document,
            find_member(document, "steps") == nullptr && find_member(document, "objects") != nullptr ? "study" : "study-steps",
            study_.file.string());
        if (find_member(document, "steps") == nullptr)
            fail_input(study_.file.string(), "lists the objects of a collection, and has no steps",
                       "use it with an operation such as 'ostraka study moulds', or name a file with steps");
        study_.title = text_in(document, "title");
        read_parameters(options);
        const JsonValue& steps = *find_member(document, "steps");
        for (const auto& member : steps.GetObject()) read_step(text_of(member.name), member.value);
        for (StudyStep& step : study_.steps) read_references(step);
        if (options.quick) remove_slow_steps();
        sort_steps();
    }

private:
    void read_parameters(const StudyOptions& options) {
        std::map<std::string, std::pair<const JsonValue*, std::string>> values;
        std::vector<std::string> names;
        const auto read_values = [&](const char* section, bool is_new) {
            const JsonValue* members = find_member(*study_.document, section);
            if (members == nullptr) return;
            for (const auto& member : members->GetObject()) {
                const std::string name = text_of(member.name), place = fmt::format("/{}/{}", section, pointer_word(name));
                if (is_new) names.push_back(name);
                else if (!values.contains(name))
                    refuse_name(place, fmt::format("there is no parameter '{}'", printable(name, 60)), name, names);
                values[name] = {&member.value, place};
            }
        };
        read_values("parameters", true);
        if (options.quick) {
            read_values("quick", false);
        } else if (const JsonValue* quick = find_member(*study_.document, "quick")) {  // wrong names are errors in any run
            for (const auto& member : quick->GetObject())
                if (const std::string name = text_of(member.name); !values.contains(name))
                    refuse_name("/quick/" + pointer_word(name), fmt::format("there is no parameter '{}'", printable(name, 60)),
                                name, names);
        }
        std::vector<std::pair<std::string, Json>> caller_values;
        for (const std::string& word : options.set) caller_values.push_back(parse_set_option(word));
        for (const auto& [name, value] : caller_values) {
            if (!values.contains(name)) {
                const std::string suggestion = nearest_name(name, names);
                fail_usage(
                    fmt::format("--set names '{}', which is not a parameter of {}", printable(name, 60), study_.file.string()),
                    suggestion.empty() ? "its parameters: " + (names.empty() ? std::string("none") : joined(names))
                                       : fmt::format("did you mean '{}'?", suggestion));
            }
            values[name].first = &value;
            if (!options.set_from_file) allow_reading(value);
        }
        std::size_t count = 0;
        for (const std::string& name : names) {
            check_cancelled();
            study_.parameters.push_back(read_parameter(study_, name, *values.at(name).first, values.at(name).second));
            study_.parameters.back().by_caller =
                !options.set_from_file && std::any_of(caller_values.begin(), caller_values.end(),
                                                      [&](const auto& caller_value) { return caller_value.first == name; });
            count += study_.parameters.back().values.size();
            if (count > 2 * static_cast<std::size_t>(maximum_values))
                fail_input(study_.at("/parameters"), fmt::format("the parameters have more than {} values", 2 * maximum_values),
                           "give fewer");
        }
    }

    /// Allows reading of files that the caller gave as parameter values.
    void allow_reading(const JsonValue& value) {
        if (value.IsString()) study_.readable.push_back(study_.folder / text_of(value));
        if (value.IsArray())
            for (const auto& element : value.GetArray()) allow_reading(element);
    }

    [[noreturn]] void refuse_name(const std::string& pointer, const std::string& problem, const std::string& name,
                                  const std::vector<std::string>& names) const {
        const std::string suggestion = nearest_name(name, names);
        fail_input(study_.at(pointer), problem,
                   !suggestion.empty() ? fmt::format("did you mean '{}'?", suggestion)
                   : names.empty()     ? "none is defined"
                                       : "defined: " + printable(joined(names), 400));
    }

    void read_step(const std::string& name, const JsonValue& value) {
        StudyStep step;
        step.name = name;
        step.place = "/steps/" + pointer_word(name);
        if (!is_name(name) || is_reserved(name))
            fail_input(study_.at(step.place), "is not a valid name of a step",
                       fmt::format("use {}; 'folder' and 'study' are reserved", name_rule));
        if (study_.parameter(name) != nullptr)
            fail_input(study_.at(step.place), "is already the name of a parameter", "give the step another name");
        const JsonValue *operation = find_member(value, "operation"), *program = find_member(value, "program");
        if ((operation == nullptr) == (program == nullptr))
            fail_input(study_.at(step.place), operation == nullptr ? "names no operation" : "names an operation and a program",
                       "give it one of the two; 'ostraka operations' lists the operations");
        step.is_slow = flag_in(value, "slow");
        if (operation != nullptr) {
            try {
                step.operation = &find_(text_of(*operation));
            } catch (const Error& error) {
                fail_input(study_.at(step.place + "/operation"), error.problem(), error.remedy());
            }
            if (step.operation->runs_others)
                fail_input(
                    study_.at(step.place + "/operation"),
                    fmt::format("'{}' runs other operations or programs and cannot be a step of a study", step.operation->name),
                    "run it as a command: ostraka " + std::string(step.operation->name));
            if (find_member(value, "reads") != nullptr)
                fail_input(study_.at(step.place + "/reads"), "applies only to programs",
                           "give the inputs of an operation in 'with'");
            if (const JsonValue* with = find_member(value, "with"))
                for (const auto& member : with->GetObject())
                    step.settings.push_back({text_of(member.name), &member.value,
                                             fmt::format("{}/with/{}", step.place, pointer_word(text_of(member.name)))});
            read_keep(step, value);
        } else {
            for (const char* member : {"with", "keep"})
                if (find_member(value, member) != nullptr)
                    fail_input(study_.at(fmt::format("{}/{}", step.place, member)), "applies only to operations",
                               "give the arguments of a program in 'program'; all files that it writes to ${folder} are kept");
            const auto read_words = [&](const char* section, std::vector<StudySetting>& target) {
                const JsonValue* words = find_member(value, section);
                for (rapidjson::SizeType i = 0; words != nullptr && i < words->Size(); ++i)
                    target.push_back({section, &(*words)[i], fmt::format("{}/{}/{}", step.place, section, i)});
            };
            read_words("program", step.program);
            read_words("reads", step.reads);
        }
        study_.steps.push_back(std::move(step));
    }

    void read_keep(StudyStep& step, const JsonValue& value) const {
        const JsonValue* keep = find_member(value, "keep");
        if (keep == nullptr) return;
        const Call call(*step.operation);
        const auto add = [&](const std::string& output, const std::string& file, const std::string& place) {
            std::vector<std::string> names;
            for (const Slot* slot : call.parameters().slots())
                if (slot->role == Role::output) names.push_back(slot->name);
            if (std::find(names.begin(), names.end(), output) == names.end())
                refuse_name(place, fmt::format("'{}' has no output '{}'", step.operation->name, printable(output, 60)), output,
                            names);
            if (!step.keep.emplace(output, study_text(file, study_.at(place))).second)
                fail_input(study_.at(place), fmt::format("'{}' is listed twice", output), "list it once");
        };
        if (keep->IsArray())
            for (rapidjson::SizeType i = 0; i < keep->Size(); ++i)
                add(text_of((*keep)[i]), "", fmt::format("{}/keep/{}", step.place, i));
        else
            for (const auto& member : keep->GetObject()) {
                const std::string name = text_of(member.name), place = fmt::format("{}/keep/{}", step.place, pointer_word(name));
                add(name, text_of(member.value), place);
            }
    }

    /// Determines the steps and parameters that a step uses; rejects references to unknown names.
    void read_references(StudyStep& step) {
        step.parameters.assign(study_.parameters.size(), false);
        const auto add_text_references = [&](const StudyText& text, const std::string& place, bool may_be_step) {
            for (const StudyReference& reference : text.references()) add_reference(step, reference, place, may_be_step);
        };
        const auto add_value_references = [&](const JsonValue& value, const std::string& place, bool may_be_step) {
            if (value.IsString()) add_text_references(study_text(text_of(value), study_.at(place)), place, may_be_step);
        };
        for (const StudySetting& setting : step.settings) {
            if (setting.value->IsObject()) {
                gather(step, text_in(*setting.value, "all"), setting.place + "/all");
            } else if (setting.value->IsArray()) {
                for (rapidjson::SizeType i = 0; i < setting.value->Size(); ++i)
                    add_value_references((*setting.value)[i], fmt::format("{}/{}", setting.place, i), true);
            } else {
                add_value_references(*setting.value, setting.place, true);
            }
        }
        for (const StudySetting& word : step.program) add_value_references(*word.value, word.place, true);
        for (const StudySetting& word : step.reads) add_value_references(*word.value, word.place, false);
        for (const auto& [output, text] : step.keep)
            add_text_references(text, fmt::format("{}/keep/{}", step.place, output), false);
    }

    void add_reference(StudyStep& step, const StudyReference& reference, const std::string& place, bool may_be_step) {
        if (step.operation == nullptr && is_reserved(reference.name) && reference.member.empty()) return;
        if (const StudyParameter* parameter = study_.parameter(reference.name)) {
            if (parameter->values.front().find(reference.member) == nullptr) {
                std::vector<std::string> members;
                for (const auto& [name, value] : parameter->values.front().members)
                    if (!name.empty()) members.push_back(name);
                refuse_name(place, fmt::format("'{}' has no member '{}'", reference.name, printable(reference.member, 60)),
                            reference.member, members);
            }
            for (const auto& value : parameter->values)
                if (value.find(reference.member) == nullptr)
                    fail_input(
                        study_.at(place),
                        fmt::format("value '{}' of '{}' has no member '{}'", value.label, reference.name, reference.member),
                        "give the member to each value");
            if (parameter->varies) step.parameters[study_.parameter_index(reference.name)] = true;
            return;
        }
        if (reference.member.empty() || !may_be_step || study_.step(reference.name) == study_.steps.size()) {
            std::vector<std::string> names;
            for (const auto& known_parameter : study_.parameters) names.push_back(known_parameter.name);
            if (may_be_step)
                for (const auto& known_step : study_.steps) names.push_back(known_step.name);
            const bool is_step = study_.step(reference.name) != study_.steps.size();
            if (is_step)
                fail_input(
                    study_.at(place),
                    fmt::format("'{}' is a step{}", reference.name, may_be_step ? "" : ", but only parameters are allowed here"),
                    may_be_step ? fmt::format("name its output: ${{{}.output}}", reference.name) : "use a parameter");
            refuse_name(place,
                        fmt::format("there is no parameter{} '{}'", may_be_step ? " or step" : "", printable(reference.name, 60)),
                        reference.name, names);
        }
        add_dependency(step, reference, place);
    }

    void add_dependency(StudyStep& step, const StudyReference& reference, const std::string& place) {
        const std::size_t other = study_.step(reference.name);
        if (&study_.steps[other] == &step) fail_input(study_.at(place), "uses its own output", "name another step");
        check_output(study_.steps[other], reference.member, place);
        step.needs.push_back(other);
    }

    void check_output(const StudyStep& step, const std::string& output, const std::string& place) const {
        if (step.operation == nullptr) return;  // a file that the program writes
        const Call call(*step.operation);
        std::vector<std::string> names;
        for (const Slot* slot : call.parameters().slots())
            if (slot->role == Role::output) names.push_back(slot->name);
        if (std::find(names.begin(), names.end(), output) == names.end())
            refuse_name(
                place, fmt::format("step '{}' ('{}') has no output '{}'", step.name, step.operation->name, printable(output, 60)),
                output, names);
    }

    void gather(StudyStep& step, const std::string& text, const std::string& place) {
        const std::size_t dot = text.find('.');
        const StudyReference reference{text.substr(0, dot), dot == std::string::npos ? "" : text.substr(dot + 1)};
        if (study_.step(reference.name) == study_.steps.size()) {
            std::vector<std::string> names;
            for (const auto& known_step : study_.steps) names.push_back(known_step.name);
            refuse_name(place, fmt::format("there is no step '{}'", printable(reference.name, 60)), reference.name, names);
        }
        if (reference.member.empty())
            fail_input(study_.at(place), "does not name an output",
                       fmt::format("write STEP.OUTPUT, such as {}.output", reference.name));
        add_dependency(step, reference, place);
        step.gathers.push_back(study_.step(reference.name));
    }

    /// Removes slow steps, and all steps that use their outputs, for quick runs.
    void remove_slow_steps() {
        std::set<std::string> removed_steps;
        for (bool has_grown = true; has_grown;) {
            has_grown = false;
            for (const StudyStep& step : study_.steps) {
                if (removed_steps.contains(step.name)) continue;
                const bool depends_on_removed = std::any_of(step.needs.begin(), step.needs.end(), [&](std::size_t need) {
                    return removed_steps.contains(study_.steps[need].name);
                });
                if (step.is_slow || depends_on_removed) has_grown = removed_steps.insert(step.name).second || has_grown;
            }
        }
        std::vector<std::size_t> new_index(study_.steps.size(), study_.steps.size());
        std::vector<StudyStep> kept;
        for (std::size_t i = 0; i < study_.steps.size(); ++i)
            if (!removed_steps.contains(study_.steps[i].name)) {
                new_index[i] = kept.size();
                kept.push_back(std::move(study_.steps[i]));
            }
        for (StudyStep& step : kept)
            for (auto* step_indices : {&step.needs, &step.gathers})
                for (std::size_t& step_index : *step_indices) step_index = new_index[step_index];
        study_.steps = std::move(kept);
        if (study_.steps.empty()) fail_input(study_.at("/steps"), "all steps are marked as slow", "run it without --quick");
    }

    /// Sorts the steps topologically. A step inherits the parameters of steps of which it uses one instance.
    void sort_steps() {
        enum class State { unvisited, open, done };
        std::vector<State> states(study_.steps.size(), State::unvisited);
        std::vector<std::size_t> sorted, path;
        const std::function<void(std::size_t)> visit = [&](std::size_t i) {
            if (states[i] == State::done) return;
            path.push_back(i);
            if (states[i] == State::open) {
                std::vector<std::string> names;
                for (auto it = std::find(path.begin(), path.end(), i); it != path.end(); ++it)
                    names.push_back(study_.steps[*it].name);
                fail_input(study_.at(study_.steps[i].place), "the step depends on itself: " + joined(names, " uses "),
                           "remove one reference of this cycle");
            }
            states[i] = State::open;
            for (const std::size_t need : study_.steps[i].needs) visit(need);
            states[i] = State::done;
            path.pop_back();
            sorted.push_back(i);
        };
        for (std::size_t i = 0; i < study_.steps.size(); ++i) visit(i);
        std::vector<std::size_t> place(sorted.size());
        for (std::size_t k = 0; k < sorted.size(); ++k) place[sorted[k]] = k;
        std::vector<StudyStep> steps(sorted.size());
        for (std::size_t k = 0; k < sorted.size(); ++k) steps[k] = std::move(study_.steps[sorted[k]]);
        for (StudyStep& step : steps) {
            for (auto* step_indices : {&step.needs, &step.gathers}) {
                for (std::size_t& step_index : *step_indices) step_index = place[step_index];
                std::sort(step_indices->begin(), step_indices->end());
            }
            for (const std::size_t need : step.needs) {
                const auto count = [&](const auto& step_indices) {
                    return std::count(step_indices.begin(), step_indices.end(), need);
                };
                if (count(step.needs) == count(step.gathers)) continue;
                for (std::size_t p = 0; p < study_.parameters.size(); ++p)
                    if (steps[need].parameters[p]) step.parameters[p] = true;
            }
            step.needs.erase(std::unique(step.needs.begin(), step.needs.end()), step.needs.end());
        }
        study_.steps = std::move(steps);
    }

    Study& study_;
    const FindOperation& find_;
};

}  // namespace

const StudyReference* StudyText::single() const {
    return parts.size() == 1 ? std::get_if<StudyReference>(&parts.front()) : nullptr;
}

std::vector<StudyReference> StudyText::references() const {
    std::vector<StudyReference> references_found;
    for (const auto& part : parts)
        if (const auto* reference = std::get_if<StudyReference>(&part)) references_found.push_back(*reference);
    return references_found;
}

StudyText study_text(const std::string& text, const std::string& place) {
    StudyText parsed;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t begin = text.find("${", at);
        if (begin != at) parsed.parts.emplace_back(text.substr(at, begin == std::string::npos ? begin : begin - at));
        if (begin == std::string::npos) break;
        const std::size_t end = text.find('}', begin);
        const std::string inside = end == std::string::npos ? "" : text.substr(begin + 2, end - begin - 2);
        const std::size_t dot = inside.find('.');
        StudyReference reference{inside.substr(0, dot), dot == std::string::npos ? "" : inside.substr(dot + 1)};
        if (!is_name(reference.name) || (dot != std::string::npos && reference.member.empty()))
            fail_input(place, fmt::format("'{}' is not a valid reference", printable(text.substr(begin), 60)),
                       "write ${PARAMETER}, ${PARAMETER.MEMBER} or ${STEP.OUTPUT}");
        parsed.parts.emplace_back(std::move(reference));
        at = end + 1;
    }
    return parsed;
}

const JsonValue* ParameterValue::find(const std::string& member) const {
    const auto entry = members.find(member);
    return entry == members.end() ? nullptr : entry->second.get();
}

const StudyParameter* Study::parameter(const std::string& name) const {
    const std::size_t i = parameter_index(name);
    return i == parameters.size() ? nullptr : &parameters[i];
}

std::size_t Study::parameter_index(const std::string& name) const {
    return static_cast<std::size_t>(
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& parameter) { return parameter.name == name; }) -
        parameters.begin());
}

std::size_t Study::step(const std::string& name) const {
    return static_cast<std::size_t>(
        std::find_if(steps.begin(), steps.end(), [&](const auto& step) { return step.name == name; }) - steps.begin());
}

void Study::require_readable(const Path& named, const std::string& pointer) const {
    if (is_inside_any(named, readable)) return;
    fail_input(at(pointer), fmt::format("'{}' lies outside the study's folder", printable(named.string(), 300)),
               "permit a further folder with --reads FOLDER");
}

std::string Study::relative(const Path& name) const {
    const auto full = [](const Path& path) { return std::filesystem::absolute(path).lexically_normal(); };
    return full(name).lexically_relative(full(folder)).generic_string();
}

bool is_own_program(const std::string& name) { return name == "ostraka_experiments"; }

std::string scalar_text(const JsonValue& value) {
    if (value.IsString()) return text_of(value);
    if (value.IsBool()) return value.GetBool() ? "true" : "false";
    return value.IsInt64() ? std::to_string(value.GetInt64()) : digits(value.GetDouble());
}

Study read_study(const Path& file, const FindOperation& find, const StudyOptions& options) {
    Study study;
    study.file = file;
    study.folder = options.folder.empty() ? file.parent_path() : options.folder;
    if (study.folder.empty()) study.folder = ".";
    study.allow_programs = options.allow_programs;
    if (options.reads_folder) study.readable = {study.folder};
    study.readable.insert(study.readable.end(), options.reads.begin(), options.reads.end());
    const std::string text = read_file(file);
    study.sha256 = sha256(text);
    study.document = std::make_shared<const Json>(parse_json(text, file.string()));
    check_format(*study.document, "ostraka-study", file.string(), "name a study file (.study.json)");
    StudyReader(study, find).read(options);
    return study;
}

}  // namespace ostraka
