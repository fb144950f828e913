#include "ostraka/workflow/study_file.h"

#include "ostraka/core/nearest_name.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/words.h"
#include "ostraka/workflow/file_pattern.h"

#include <algorithm>
#include <functional>
#include <set>

namespace ostraka {

namespace {

constexpr const char* name_rule = "letters, digits, '-' and '_', a letter first";
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
    ParameterValue made;
    for (const auto& member : value.GetObject()) made.members[text_of(member.name)] = copy_of(member.value);
    const auto name = made.members.find("name");
    made.label = name == made.members.end() ? std::to_string(number + 1) : scalar_text(*name->second);
    made.members[""] = text_value(made.label);
    return made;
}

/// The file relative to the study's folder, like all other files of the study.
ParameterValue file_value(const Study& study, const Path& found) {
    const Path file = study.relative(found);
    ParameterValue made;
    made.label = file.stem().string();
    made.members[""] = text_value(file.string());
    made.members["name"] = text_value(file.filename().string());
    made.members["stem"] = text_value(file.stem().string());
    made.members["folder"] = text_value(file.parent_path().string());
    return made;
}

StudyParameter read_parameter(const Study& study, const std::string& name, const JsonValue& value, const std::string& place) {
    StudyParameter parameter{name, {}, false, true};
    if (!is_name(name) || is_reserved(name))
        fail_input(study.at(place), "is no name for a parameter",
                   std::string("use ") + name_rule + ", and neither 'folder' nor 'study'");
    if (value.IsArray()) {
        for (const auto& one : value.GetArray())
            parameter.values.push_back(one.IsObject() ? case_value(one, parameter.values.size()) : scalar_value(one));
    } else if (value.IsObject() && find_member(value, "files") != nullptr) {
        const Path pattern = (study.folder / text_in(value, "files")).lexically_normal();
        study.require_readable(before_wildcards(pattern), place + "/files");
        for (const Path& file :
             matching_files(pattern, [&](const Path& folder) { return is_inside_any(folder, study.readable); })) {
            study.require_readable(file, place + "/files");
            parameter.values.push_back(file_value(study, file));
        }
        if (parameter.values.empty())
            fail_input(study.at(place + "/files"), "no file is called '" + pattern.string() + "'",
                       "names are relative to the study file; * stands for any letters, ? for one");
    } else if (value.IsObject()) {
        const std::int64_t from = find_member(value, "from")->GetInt64(), to = find_member(value, "to")->GetInt64();
        const JsonValue* given = find_member(value, "step");
        const std::int64_t step = given == nullptr ? 1 : given->GetInt64();
        if (to < from) fail_input(study.at(place), "ends before it begins", "give 'to' a number that is not below 'from'");
        const std::int64_t last = (to - from) / step;  // the schema's bounds prevent overflow
        if (last >= maximum_values)
            fail_input(study.at(place), "has more than " + std::to_string(maximum_values) + " values", "give fewer");
        for (std::int64_t i = 0; i <= last; ++i)
            parameter.values.push_back(scalar_value(Json(rapidjson::kNullType).SetInt64(from + i * step)));
    } else {
        parameter.values.push_back(scalar_value(value));
        parameter.varies = false;
    }
    std::set<std::string> labels;
    for (const auto& one : parameter.values)
        if (!labels.insert(one.label).second)
            fail_input(study.at(place), "has '" + printable(one.label, 60) + "' twice", "give each value once");
    return parameter;
}

/// Converts "NAME=VALUE,VALUE" of the command line to the form of the file.
std::pair<std::string, Json> given_parameter(const std::string& word) {
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == word.size())
        fail_usage("--set is '" + printable(word, 60) + "'", "give NAME=VALUE, or NAME=VALUE,VALUE");
    const std::string text = word.substr(equals + 1);
    Json value;
    const auto one = [&](const std::string& part) {
        JsonValue made;
        if (part == "true" || part == "false") made.SetBool(part == "true");
        else if (const auto number = number_of(part)) {
            if (*number == std::floor(*number) && std::abs(*number) < 1e15) made.SetInt64(static_cast<std::int64_t>(*number));
            else made.SetDouble(*number);
        } else made = json_string(part, value.GetAllocator());
        return made;
    };
    if (text.find(',') == std::string::npos) {
        static_cast<JsonValue&>(value) = one(text);
    } else {
        value.SetArray();
        std::size_t begin = 0;
        for (std::size_t at = 0; at <= text.size(); ++at)
            if (at == text.size() || text[at] == ',') {
                value.PushBack(one(text.substr(begin, at - begin)), value.GetAllocator());
                begin = at + 1;
            }
    }
    return {word.substr(0, equals), std::move(value)};
}

class Reader {
public:
    Reader(Study& study, const FindOperation& find) : study_(study), find_(find) {}

    void read(const StudyOptions& options) {
        const Json& document = *study_.document;
        validate(
            document,
            find_member(document, "steps") == nullptr && find_member(document, "objects") != nullptr ? "study" : "study-steps",
            study_.file.string());
        if (find_member(document, "steps") == nullptr)
            fail_input(study_.file.string(), "lists the objects of a collection, and has no steps",
                       "give it to an operation such as 'ostraka study moulds', or name a file with steps");
        study_.title = text_in(document, "title");
        read_parameters(options);
        const JsonValue& steps = *find_member(document, "steps");
        for (const auto& member : steps.GetObject()) read_step(text_of(member.name), member.value);
        for (StudyStep& step : study_.steps) read_references(step);
        if (options.quick) leave_out_slow();
        order();
    }

private:
    void read_parameters(const StudyOptions& options) {
        std::map<std::string, std::pair<const JsonValue*, std::string>> values;
        std::vector<std::string> names;
        const auto take = [&](const char* list, bool is_new) {
            const JsonValue* members = find_member(*study_.document, list);
            if (members == nullptr) return;
            for (const auto& member : members->GetObject()) {
                const std::string name = text_of(member.name), place = std::string("/") + list + "/" + pointer_word(name);
                if (is_new) names.push_back(name);
                else if (!values.contains(name))
                    refuse_name(place, "there is no parameter '" + printable(name, 60) + "'", name, names);
                values[name] = {&member.value, place};
            }
        };
        take("parameters", true);
        if (options.quick) {
            take("quick", false);
        } else if (const JsonValue* quick = find_member(*study_.document, "quick")) {  // wrong names are errors in any run
            for (const auto& member : quick->GetObject())
                if (const std::string name = text_of(member.name); !values.contains(name))
                    refuse_name("/quick/" + pointer_word(name), "there is no parameter '" + printable(name, 60) + "'", name,
                                names);
        }
        std::vector<std::pair<std::string, Json>> given;
        for (const std::string& word : options.set) given.push_back(given_parameter(word));
        for (const auto& [name, value] : given) {
            if (!values.contains(name)) {
                const std::string near = nearest_name(name, names);
                fail_usage("--set names '" + printable(name, 60) + "', which is no parameter of " + study_.file.string(),
                           near.empty() ? "its parameters: " + (names.empty() ? std::string("none") : joined(names))
                                        : "did you mean '" + near + "'?");
            }
            values[name].first = &value;
            if (!options.set_from_file) allow_given(value);
        }
        std::size_t count = 0;
        for (const std::string& name : names) {
            check_cancelled();
            study_.parameters.push_back(read_parameter(study_, name, *values.at(name).first, values.at(name).second));
            study_.parameters.back().by_caller =
                !options.set_from_file &&
                std::any_of(given.begin(), given.end(), [&](const auto& one) { return one.first == name; });
            count += study_.parameters.back().values.size();
            if (count > 2 * static_cast<std::size_t>(maximum_values))
                fail_input(study_.at("/parameters"),
                           "the parameters have more than " + std::to_string(2 * maximum_values) + " values", "give fewer");
        }
    }

    /// Allows reading of files that the caller gave as parameter values.
    void allow_given(const JsonValue& value) {
        if (value.IsString()) study_.readable.push_back(study_.folder / text_of(value));
        if (value.IsArray())
            for (const auto& one : value.GetArray()) allow_given(one);
    }

    [[noreturn]] void refuse_name(const std::string& pointer, const std::string& what, const std::string& name,
                                  const std::vector<std::string>& names) const {
        const std::string near = nearest_name(name, names);
        fail_input(study_.at(pointer), what,
                   !near.empty()   ? "did you mean '" + near + "'?"
                   : names.empty() ? "there is none"
                                   : "there are: " + printable(joined(names), 400));
    }

    void read_step(const std::string& name, const JsonValue& value) {
        StudyStep step;
        step.name = name;
        step.place = "/steps/" + pointer_word(name);
        if (!is_name(name) || is_reserved(name))
            fail_input(study_.at(step.place), "is no name for a step",
                       std::string("use ") + name_rule + ", and neither 'folder' nor 'study'");
        if (study_.parameter(name) != nullptr)
            fail_input(study_.at(step.place), "is the name of a parameter as well", "give the step another name");
        const JsonValue *operation = find_member(value, "operation"), *program = find_member(value, "program");
        if ((operation == nullptr) == (program == nullptr))
            fail_input(study_.at(step.place), operation == nullptr ? "names no operation" : "names an operation and a program",
                       "give it one: 'ostraka operations' lists the operations");
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
                    "'" + std::string(step.operation->name) + "' runs other operations or programs, and is no step of a study",
                    "run it as a command: ostraka " + std::string(step.operation->name));
            if (find_member(value, "reads") != nullptr)
                fail_input(study_.at(step.place + "/reads"), "is for programs", "an operation takes its inputs in 'with'");
            if (const JsonValue* with = find_member(value, "with"))
                for (const auto& member : with->GetObject())
                    step.settings.push_back(
                        {text_of(member.name), &member.value, step.place + "/with/" + pointer_word(text_of(member.name))});
            read_keep(step, value);
        } else {
            for (const char* member : {"with", "keep"})
                if (find_member(value, member) != nullptr)
                    fail_input(study_.at(step.place + "/" + member), "is for operations",
                               "a program takes words, and all that it writes into ${folder} is kept");
            const auto take = [&](const char* list, std::vector<StudySetting>& to) {
                const JsonValue* words = find_member(value, list);
                for (rapidjson::SizeType i = 0; words != nullptr && i < words->Size(); ++i)
                    to.push_back({list, &(*words)[i], step.place + "/" + list + "/" + std::to_string(i)});
            };
            take("program", step.program);
            take("reads", step.reads);
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
                refuse_name(place, "'" + std::string(step.operation->name) + "' has no output '" + printable(output, 60) + "'",
                            output, names);
            if (!step.keep.emplace(output, study_text(file, study_.at(place))).second)
                fail_input(study_.at(place), "'" + output + "' is kept twice", "name it once");
        };
        if (keep->IsArray())
            for (rapidjson::SizeType i = 0; i < keep->Size(); ++i)
                add(text_of((*keep)[i]), "", step.place + "/keep/" + std::to_string(i));
        else
            for (const auto& member : keep->GetObject()) {
                const std::string name = text_of(member.name), place = step.place + "/keep/" + pointer_word(name);
                add(name, text_of(member.value), place);
            }
    }

    /// Determines the steps and parameters that a step uses; rejects references to unknown names.
    void read_references(StudyStep& step) {
        step.parameters.assign(study_.parameters.size(), false);
        const auto take = [&](const StudyText& text, const std::string& place, bool may_be_step) {
            for (const StudyReference& reference : text.references()) take_reference(step, reference, place, may_be_step);
        };
        const auto take_value = [&](const JsonValue& value, const std::string& place, bool may_be_step) {
            if (value.IsString()) take(study_text(text_of(value), study_.at(place)), place, may_be_step);
        };
        for (const StudySetting& setting : step.settings) {
            if (setting.value->IsObject()) {
                gather(step, text_in(*setting.value, "all"), setting.place + "/all");
            } else if (setting.value->IsArray()) {
                for (rapidjson::SizeType i = 0; i < setting.value->Size(); ++i)
                    take_value((*setting.value)[i], setting.place + "/" + std::to_string(i), true);
            } else {
                take_value(*setting.value, setting.place, true);
            }
        }
        for (const StudySetting& word : step.program) take_value(*word.value, word.place, true);
        for (const StudySetting& word : step.reads) take_value(*word.value, word.place, false);
        for (const auto& [output, text] : step.keep) take(text, step.place + "/keep/" + output, false);
    }

    void take_reference(StudyStep& step, const StudyReference& reference, const std::string& place, bool may_be_step) {
        if (step.operation == nullptr && is_reserved(reference.name) && reference.member.empty()) return;
        if (const StudyParameter* parameter = study_.parameter(reference.name)) {
            if (parameter->values.front().find(reference.member) == nullptr) {
                std::vector<std::string> members;
                for (const auto& [name, value] : parameter->values.front().members)
                    if (!name.empty()) members.push_back(name);
                refuse_name(place, "'" + reference.name + "' has no member '" + printable(reference.member, 60) + "'",
                            reference.member, members);
            }
            for (const auto& value : parameter->values)
                if (value.find(reference.member) == nullptr)
                    fail_input(study_.at(place),
                               "value '" + value.label + "' of '" + reference.name + "' has no member '" + reference.member + "'",
                               "give it to each");
            if (parameter->varies) step.parameters[study_.parameter_index(reference.name)] = true;
            return;
        }
        if (reference.member.empty() || !may_be_step || study_.step(reference.name) == study_.steps.size()) {
            std::vector<std::string> names;
            for (const auto& one : study_.parameters) names.push_back(one.name);
            if (may_be_step)
                for (const auto& one : study_.steps) names.push_back(one.name);
            const bool is_step = study_.step(reference.name) != study_.steps.size();
            if (is_step)
                fail_input(study_.at(place),
                           "'" + reference.name + "' is a step" + (may_be_step ? "" : ", and parameters stand here"),
                           may_be_step ? "name its output: ${" + reference.name + ".output}" : "use a parameter");
            refuse_name(
                place,
                "there is no parameter" + std::string(may_be_step ? " or step" : "") + " '" + printable(reference.name, 60) + "'",
                reference.name, names);
        }
        need(step, reference, place);
    }

    void need(StudyStep& step, const StudyReference& reference, const std::string& place) {
        const std::size_t other = study_.step(reference.name);
        if (&study_.steps[other] == &step) fail_input(study_.at(place), "takes its own output", "name another step");
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
            refuse_name(place,
                        "step '" + step.name + "' ('" + step.operation->name + "') has no output '" + printable(output, 60) + "'",
                        output, names);
    }

    void gather(StudyStep& step, const std::string& text, const std::string& place) {
        const std::size_t dot = text.find('.');
        const StudyReference reference{text.substr(0, dot), dot == std::string::npos ? "" : text.substr(dot + 1)};
        if (study_.step(reference.name) == study_.steps.size()) {
            std::vector<std::string> names;
            for (const auto& one : study_.steps) names.push_back(one.name);
            refuse_name(place, "there is no step '" + printable(reference.name, 60) + "'", reference.name, names);
        }
        if (reference.member.empty())
            fail_input(study_.at(place), "names no output", "write STEP.OUTPUT, such as " + reference.name + ".output");
        need(step, reference, place);
        step.gathers.push_back(study_.step(reference.name));
    }

    /// Removes slow steps, and all steps that use their outputs, for quick runs.
    void leave_out_slow() {
        std::set<std::string> out;
        for (bool more = true; more;) {
            more = false;
            for (const StudyStep& step : study_.steps) {
                if (out.contains(step.name)) continue;
                const bool without = std::any_of(step.needs.begin(), step.needs.end(),
                                                 [&](std::size_t need) { return out.contains(study_.steps[need].name); });
                if (step.is_slow || without) more = out.insert(step.name).second || more;
            }
        }
        std::vector<std::size_t> new_index(study_.steps.size(), study_.steps.size());
        std::vector<StudyStep> kept;
        for (std::size_t i = 0; i < study_.steps.size(); ++i)
            if (!out.contains(study_.steps[i].name)) {
                new_index[i] = kept.size();
                kept.push_back(std::move(study_.steps[i]));
            }
        for (StudyStep& step : kept)
            for (auto* list : {&step.needs, &step.gathers})
                for (std::size_t& one : *list) one = new_index[one];
        study_.steps = std::move(kept);
        if (study_.steps.empty()) fail_input(study_.at("/steps"), "all steps are slow", "run it without --quick");
    }

    /// Sorts the steps topologically. A step inherits the parameters of steps of which it uses one instance.
    void order() {
        enum class Mark { unseen, open, done };
        std::vector<Mark> marks(study_.steps.size(), Mark::unseen);
        std::vector<std::size_t> sorted, way;
        const std::function<void(std::size_t)> visit = [&](std::size_t i) {
            if (marks[i] == Mark::done) return;
            way.push_back(i);
            if (marks[i] == Mark::open) {
                std::vector<std::string> names;
                for (auto it = std::find(way.begin(), way.end(), i); it != way.end(); ++it)
                    names.push_back(study_.steps[*it].name);
                fail_input(study_.at(study_.steps[i].place), "its inputs come from itself: " + joined(names, " takes "),
                           "break the circle");
            }
            marks[i] = Mark::open;
            for (const std::size_t need : study_.steps[i].needs) visit(need);
            marks[i] = Mark::done;
            way.pop_back();
            sorted.push_back(i);
        };
        for (std::size_t i = 0; i < study_.steps.size(); ++i) visit(i);
        std::vector<std::size_t> place(sorted.size());
        for (std::size_t k = 0; k < sorted.size(); ++k) place[sorted[k]] = k;
        std::vector<StudyStep> steps(sorted.size());
        for (std::size_t k = 0; k < sorted.size(); ++k) steps[k] = std::move(study_.steps[sorted[k]]);
        for (StudyStep& step : steps) {
            for (auto* list : {&step.needs, &step.gathers}) {
                for (std::size_t& one : *list) one = place[one];
                std::sort(list->begin(), list->end());
            }
            for (const std::size_t need : step.needs) {
                const auto count = [&](const auto& list) { return std::count(list.begin(), list.end(), need); };
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
    std::vector<StudyReference> found;
    for (const auto& part : parts)
        if (const auto* reference = std::get_if<StudyReference>(&part)) found.push_back(*reference);
    return found;
}

StudyText study_text(const std::string& text, const std::string& where) {
    StudyText made;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t begin = text.find("${", at);
        if (begin != at) made.parts.emplace_back(text.substr(at, begin == std::string::npos ? begin : begin - at));
        if (begin == std::string::npos) break;
        const std::size_t end = text.find('}', begin);
        const std::string inside = end == std::string::npos ? "" : text.substr(begin + 2, end - begin - 2);
        const std::size_t dot = inside.find('.');
        StudyReference reference{inside.substr(0, dot), dot == std::string::npos ? "" : inside.substr(dot + 1)};
        if (!is_name(reference.name) || (dot != std::string::npos && reference.member.empty()))
            fail_input(where, "'" + printable(text.substr(begin), 60) + "' is no reference",
                       "write ${PARAMETER}, ${PARAMETER.MEMBER} or ${STEP.OUTPUT}");
        made.parts.emplace_back(std::move(reference));
        at = end + 1;
    }
    return made;
}

const JsonValue* ParameterValue::find(const std::string& member) const {
    const auto found = members.find(member);
    return found == members.end() ? nullptr : found->second.get();
}

const StudyParameter* Study::parameter(const std::string& name) const {
    const std::size_t i = parameter_index(name);
    return i == parameters.size() ? nullptr : &parameters[i];
}

std::size_t Study::parameter_index(const std::string& name) const {
    return static_cast<std::size_t>(
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& one) { return one.name == name; }) -
        parameters.begin());
}

std::size_t Study::step(const std::string& name) const {
    return static_cast<std::size_t>(std::find_if(steps.begin(), steps.end(), [&](const auto& one) { return one.name == name; }) -
                                    steps.begin());
}

void Study::require_readable(const Path& named, const std::string& pointer) const {
    if (is_inside_any(named, readable)) return;
    fail_input(at(pointer), "'" + printable(named.string(), 300) + "' lies outside of the study's folder",
               "allow a further folder to be read: --reads FOLDER");
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
    Reader(study, find).read(options);
    return study;
}

}  // namespace ostraka
