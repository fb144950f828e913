#include "ostraka/workflow/plan.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/words.h"

#include <algorithm>

namespace ostraka {

namespace {

constexpr std::size_t maximum_instances = 100'000, maximum_inputs = 1'000'000;

/// Placeholder for an output of another instance that does not exist yet.
struct Promised {};

/// A portable folder name for a label; different labels give different names.
std::string folder_name(const std::string& label) {
    std::string name;
    bool changed = label.size() > 120;
    for (const char c : label.substr(0, 100)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
                           c == '.' || c == '=' || c == ',' || c == '+';
        name += plain ? c : '_';
        changed = changed || !plain;
    }
    return changed ? name + "-" + sha256(label).substr(0, 12) : name;
}

std::string file_of(const std::string& step, const std::string& output, const std::string& ending) {
    return (output == "output" ? step : step + "-" + output) + ending;
}

/// Whether a text contains an absolute path or one with "..", also after characters that programs treat as separators.
bool leads_out(const std::string& text) {
    static const std::string signs = "=,:;@";
    std::string part;
    const auto is_out = [&] {
        const Path path(part);
        return path.is_absolute() || std::any_of(path.begin(), path.end(), [](const Path& one) { return one == ".."; }) ||
               (part.starts_with("-") && part.find('/') != std::string::npos);
    };
    for (const char c : text) {
        if (signs.find(c) == std::string::npos) {
            part += c;
            continue;
        }
        if (is_out()) return true;
        part.clear();
    }
    return is_out();
}

}  // namespace

bool fits(Kind given, Kind asked) {
    const auto is_any_of = [](Kind kind, std::initializer_list<Kind> kinds) {
        return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    };
    if (given == asked || asked == Kind::text || given == Kind::text) return true;
    for (const auto& same :
         {std::pair(Kind::mesh, Kind::cage), std::pair(Kind::folder, Kind::collection), std::pair(Kind::table, Kind::report)})
        if (is_any_of(given, {same.first, same.second}) && is_any_of(asked, {same.first, same.second})) return true;
    return asked == Kind::collection && is_any_of(given, {Kind::mesh, Kind::annotations, Kind::landmarks});
}

std::string StudyInstance::title(const Study& study) const {
    return study.steps[step].name + (label.empty() ? "" : " (" + label + ")");
}

StudyPlan::StudyPlan(Study of) : study(std::move(of)), index_(study.steps.size()) {
    for (std::size_t i = 0; i < study.steps.size(); ++i) add_step(i);
    for (StudyInstance& instance : instances) make_outputs(instance);
    for (const StudyInstance& instance : instances) {
        check_cancelled();
        check(instance);
    }
    check_outputs();
}

void StudyPlan::add_step(std::size_t i) {
    const StudyStep& step = study.steps[i];
    std::vector<std::size_t> varying;
    std::size_t count = 1;
    for (std::size_t p = 0; p < study.parameters.size(); ++p)
        if (step.parameters[p]) {
            varying.push_back(p);
            count *= study.parameters[p].values.size();
            if (count + instances.size() > maximum_instances)
                fail_input(study.at(step.place),
                           "the study comes to more than " + std::to_string(maximum_instances) + " instances of steps",
                           "give fewer values");
        }
    for (std::size_t k = 0; k < count; ++k) {
        std::vector<std::size_t> values(study.parameters.size(), no_instance);
        std::size_t rest = k;
        for (auto p = varying.rbegin(); p != varying.rend(); ++p) {
            values[*p] = rest % study.parameters[*p].values.size();
            rest /= study.parameters[*p].values.size();
        }
        index_[i][values] = instances.size();
        instances.push_back(make_instance(i, values));
        check_counts(instances.back());
    }
}

void StudyPlan::check_counts(const StudyInstance& instance) {
    check_cancelled();
    inputs_ += instance.inputs.size();
    if (inputs_ > maximum_inputs)
        fail_input(study.at(study.steps[instance.step].place),
                   "the instances of the study take more than " + std::to_string(maximum_inputs) + " inputs",
                   "give fewer values, or gather fewer");
}

StudyInstance StudyPlan::make_instance(std::size_t i, const std::vector<std::size_t>& values) {
    const StudyStep& step = study.steps[i];
    StudyInstance instance;
    instance.step = i;
    instance.values = values;
    for (std::size_t p = 0; p < values.size(); ++p)
        if (values[p] != no_instance)
            instance.label += (instance.label.empty() ? "" : ",") + study.parameters[p].name + "=" +
                              study.parameters[p].values[values[p]].label;
    instance.folder = Path("steps") / step.name;
    if (!instance.label.empty()) instance.folder /= folder_name(instance.label);
    auto options = std::make_shared<Json>(rapidjson::kObjectType);
    if (step.operation != nullptr) {
        const Call call(*step.operation);
        for (const StudySetting& setting : step.settings) {
            if (setting.value->IsObject()) {
                const std::string text = text_in(*setting.value, "all");
                const std::size_t dot = text.find('.');
                add_output(instance, setting, {text.substr(0, dot), text.substr(dot + 1)}, setting.place + "/all", {});
                continue;
            }
            set_value(instance, setting, *setting.value, setting.place, call, *options, options->GetAllocator());
        }
        for (const auto& [output, text] : step.keep) {
            std::string name = filled(text, instance);
            if (name.empty()) name = file_of(step.name, output, call.usual_ending(output));
            require_plain_name(name, study.file.string(), step.place + "/keep/" + output);
            if (name == "report.json" || name == "record.json" || name == "output.txt")
                fail_input(study.at(step.place + "/keep/" + output), "'" + name + "' is written for every step",
                           "name it otherwise");
            instance.outputs[output] = name;
            instance.kept.insert(output);
        }
    } else {
        for (const StudySetting& word : step.program) {
            const StudyText text = word.value->IsString() ? study_text(text_of(*word.value), study.at(word.place))
                                                          : StudyText{{scalar_text(*word.value)}};
            const StudyReference* one = text.single();
            const auto is_place = [](const StudyReference& reference) {
                return reference.name == "folder" || reference.name == "study";
            };
            if (one != nullptr && study.parameter(one->name) == nullptr && !is_place(*one)) {
                add_output(instance, {"program", word.value, word.place}, *one, word.place, {});
                instance.program.emplace_back();  // filled in from the inputs in order
            } else {
                for (const StudyReference& reference : text.references())
                    if (study.parameter(reference.name) == nullptr && !is_place(reference))
                        fail_input(study.at(word.place), "an output of a step stands within other text",
                                   "let it be a word of its own");
                instance.program.push_back(text.parts.empty() ? std::string() : filled(text, instance));
                if (instance.program.back().empty()) fail_input(study.at(word.place), "is an empty word", "leave it out");
                check_word(word, text, instance.program.back());
            }
        }
        if (const std::string& name = instance.program.front(); !study.allow_programs && !is_own_program(name))
            fail_input(study.at(step.place + "/program/0"),
                       "starts '" + printable(name, 60) + "', which is none of the toolkit's own programs",
                       "see all words of it by --dry-run; --allow-programs allows it");
        for (const StudySetting& word : step.reads) {
            const Path file =
                (study.folder / filled(study_text(text_of(*word.value), study.at(word.place)), instance)).lexically_normal();
            study.require_readable(file, word.place);
            if (!file_exists(file) && !is_folder(file))
                fail_input(study.at(word.place), "'" + file.string() + "' is not there", "names are relative to the study file");
            instance.inputs.push_back({"reads", {}, file, no_instance, {}, false});
        }
    }
    instance.options = options;
    for (const StudyInput& input : instance.inputs)
        if (input.instance != no_instance) instance.needs.push_back(input.instance);
    std::sort(instance.needs.begin(), instance.needs.end());
    instance.needs.erase(std::unique(instance.needs.begin(), instance.needs.end()), instance.needs.end());
    return instance;
}

/// Throws if a word of a program names a path outside the instance's folder and the readable folders. Study files may be
/// untrusted.
void StudyPlan::check_word(const StudySetting& word, const StudyText& text, const std::string& filled) const {
    const auto is_the_callers = [&](const StudyReference& reference) {
        const StudyParameter* parameter = study.parameter(reference.name);
        return parameter != nullptr && parameter->by_caller;
    };
    const auto references = text.references();
    if (study.allow_programs || std::any_of(references.begin(), references.end(), is_the_callers)) return;
    const std::size_t equals = filled.starts_with("-") ? filled.find('=') : std::string::npos;
    std::string named = filled.substr(equals == std::string::npos ? 0 : equals + 1);
    const auto takes = [&](const std::string& mark) {  // as a prefix, and only as a whole folder name
        if (!named.starts_with(mark) || (named.size() > mark.size() && named[mark.size()] != '/')) return false;
        named.erase(0, mark.size());
        return true;
    };
    const bool is_in_study = takes("${study}"), is_in_folder = !is_in_study && takes("${folder}");
    if (is_in_study) study.require_readable(study.folder / ("." + named), word.place);
    if (leads_out(is_in_study || is_in_folder ? "." + named : named) || named.find("${") != std::string::npos)
        fail_input(study.at(word.place), "'" + printable(filled, 100) + "' may lead out of the folder of the step",
                   "use ${folder}, ${study} or an output of a step; --allow-programs allows any words");
}

const JsonValue* StudyPlan::value(const StudyInstance& instance, const StudyReference& reference) const {
    const std::size_t p = study.parameter_index(reference.name);
    if (p == study.parameters.size()) return nullptr;
    const StudyParameter& parameter = study.parameters[p];
    if (parameter.varies && instance.values[p] == no_instance) return nullptr;
    return parameter.values[parameter.varies ? instance.values[p] : 0].find(reference.member);
}

std::string StudyPlan::filled(const StudyText& text, const StudyInstance& instance) const {
    std::string all;
    for (const auto& part : text.parts)
        if (const auto* literal = std::get_if<std::string>(&part)) {
            all += *literal;
        } else {
            const auto& reference = std::get<StudyReference>(part);
            const JsonValue* known = value(instance, reference);
            all += known != nullptr ? scalar_text(*known) : "${" + reference.name + "}";
        }
    return all;
}

void StudyPlan::set_value(StudyInstance& instance, const StudySetting& setting, const JsonValue& value_there,
                          const std::string& place, const Call& call, JsonValue& options, JsonAllocator& allocator) {
    const Slot* slot = call.parameters().slot(setting.name);
    if (slot == nullptr && call.parameters().options.find(setting.name) == nullptr) {
        try {
            call.no_such_name(setting.name);
        } catch (const Error& error) {
            fail_input(study.at(place), "'" + std::string(call.entry().name) + "' " + error.problem(), error.remedy());
        }
    }
    if (slot != nullptr && slot->role == Role::output) {
        if (!value_there.IsTrue() && !value_there.IsString())
            fail_input(study.at(place), "'" + setting.name + "' is an output", "name it in 'keep'");
        fail_input(study.at(place), "'" + setting.name + "' is an output, which 'with' does not take",
                   "name it in 'keep': {\"" + setting.name + "\": \"FILE\"}");
    }
    if (slot != nullptr) {
        if (value_there.IsArray()) {
            if (!slot->repeated && value_there.Size() != 1)
                fail_input(study.at(place), "'" + setting.name + "' takes one file", "give one");
            for (rapidjson::SizeType k = 0; k < value_there.Size(); ++k)
                set_value(instance, setting, value_there[k], place + "/" + std::to_string(k), call, options, allocator);
            return;
        }
        if (!value_there.IsString())
            fail_input(study.at(place), "'" + setting.name + "' has a value of another type",
                       "give the name of a file, or an output: ${STEP.output}");
        StudyText text = study_text(text_of(value_there), study.at(place));
        std::string label;
        if (slot->is_named && !text.parts.empty()) {
            auto* literal = std::get_if<std::string>(&text.parts.front());
            const std::size_t equals = literal == nullptr ? std::string::npos : literal->find('=');
            if (literal == nullptr || equals == 0 || equals == std::string::npos)
                fail_input(study.at(place), "'" + setting.name + "' wants a name for the file", "give NAME=FILE");
            label = literal->substr(0, equals);
            if (*literal = literal->substr(equals + 1); literal->empty()) text.parts.erase(text.parts.begin());
        }
        for (const StudyReference& reference : text.references())
            if (study.parameter(reference.name) == nullptr) {
                if (text.single() == nullptr)
                    fail_input(study.at(place), "an output of a step stands within other text", "let ${STEP.output} stand alone");
                add_output(instance, setting, reference, place, label);
                return;
            }
        const std::string name = filled(text, instance);
        if (name.empty()) fail_input(study.at(place), "'" + setting.name + "' is empty", "name a file");
        StudyInput input{setting.name, label, {}, no_instance, {}, false};
        if (!(slot->takes_none && name == "none")) {
            input.file = (study.folder / name).lexically_normal();
            if (is_memory(input.file)) input.file = "./" + name;
            study.require_readable(input.file, place);
        }
        if (!input.file.empty() && !file_exists(input.file) && !is_folder(input.file))
            fail_input(study.at(place), "'" + input.file.string() + "' is not there", "names are relative to the study file");
        const auto endings = endings_of(slot->kind);
        const bool by_ending = slot->kind == Kind::mesh || slot->kind == Kind::cage || slot->kind == Kind::coordinates;
        if (by_ending && !input.file.empty() && std::find(endings.begin(), endings.end(), extension(input.file)) == endings.end())
            fail_input(study.at(place),
                       "'" + input.file.filename().string() + "' is no " + to_string(slot->kind) + " by its name",
                       "its ending must be one of " + joined(endings));
        instance.inputs.push_back(std::move(input));
        return;
    }
    if (!call.parameters().options.find(setting.name)->from_files)
        fail_input(study.at(place), "'" + setting.name + "' may be set by the caller only", "leave it out");
    const auto resolved = [&](const JsonValue& given, const std::string& at) {
        if (!given.IsString()) return JsonValue(given, allocator);
        const StudyText text = study_text(text_of(given), study.at(at));
        for (const StudyReference& reference : text.references())
            if (study.parameter(reference.name) == nullptr)
                fail_input(study.at(at), "'" + setting.name + "' is an option, and '" + reference.name + "' a step",
                           "outputs of steps are given to inputs");
        if (const StudyReference* one = text.single()) return JsonValue(*value(instance, *one), allocator);
        return json_string(filled(text, instance), allocator);
    };
    JsonValue made;
    if (value_there.IsArray()) {
        made.SetArray();
        for (rapidjson::SizeType k = 0; k < value_there.Size(); ++k)
            made.PushBack(resolved(value_there[k], place + "/" + std::to_string(k)), allocator);
    } else {
        made = resolved(value_there, place);
    }
    add_member(options, setting.name, std::move(made), allocator);
}

void StudyPlan::add_output(StudyInstance& instance, const StudySetting& setting, const StudyReference& reference,
                           const std::string& place, const std::string& label) {
    const StudyStep& step = study.steps[instance.step];
    const std::size_t from = study.step(reference.name);
    const StudyStep& other = study.steps[from];
    const bool all = setting.value->IsObject();
    bool on_disk = false;
    if (step.operation != nullptr && other.operation != nullptr) {
        const Call taking(*step.operation), giving(*other.operation);
        const Slot *asked = taking.parameters().slot(setting.name), *given = giving.parameters().slot(reference.member);
        if (asked == nullptr) {
            if (taking.parameters().options.find(setting.name) == nullptr) {
                try {
                    taking.no_such_name(setting.name);
                } catch (const Error& error) {
                    fail_input(study.at(place), "'" + std::string(step.operation->name) + "' " + error.problem(), error.remedy());
                }
            }
            fail_input(study.at(place), "'" + setting.name + "' is an option", "outputs of steps are given to inputs");
        }
        if (asked->role != Role::input) fail_input(study.at(place), "'" + setting.name + "' is an output", "name it in 'keep'");
        if (!fits(given->kind, asked->kind))
            fail_input(study.at(place),
                       "'" + setting.name + "' of '" + step.operation->name + "' takes " + to_string(asked->kind) + ", and '" +
                           reference.name + "." + reference.member + "' is " + to_string(given->kind),
                       "give it an output of that kind");
        if (all && !asked->repeated && asked->kind != Kind::collection)
            fail_input(study.at(place), "'" + setting.name + "' takes one " + to_string(asked->kind),
                       "give it one: ${" + reference.name + "." + reference.member + "}");
        on_disk = given->kind == Kind::mesh && asked->reads_beside;
        if (on_disk && !other.keep.contains(reference.member))
            fail_input(study.at(place),
                       "'" + std::string(step.operation->name) + "' reads what stands beside a file too (NAME.ant.json), and '" +
                           reference.name + "." + reference.member + "' is not kept",
                       R"(let step ')" + reference.name + R"(' have "keep": {")" + reference.member +
                           R"(": "NAME.ply"}, and its annotations as "NAME.ant.json")");
    }
    const bool keep = step.operation == nullptr;  // programs read files
    const auto add = [&](std::size_t source) {
        if (other.operation != nullptr) want(source, reference.member, keep);
        instance.inputs.push_back({setting.name, label, {}, source, reference.member, on_disk});
    };
    if (!all) return add(instance_of(from, instance));
    for (const auto& [values, i] : index_[from]) {
        bool agrees = true;
        for (std::size_t p = 0; p < values.size(); ++p)
            agrees = agrees && (values[p] == no_instance || instance.values[p] == no_instance || values[p] == instance.values[p]);
        if (agrees) add(i);
    }
}

std::size_t StudyPlan::instance_of(std::size_t step, const StudyInstance& of) const {
    std::vector<std::size_t> values = of.values;
    for (std::size_t p = 0; p < values.size(); ++p)
        if (!study.steps[step].parameters[p]) values[p] = no_instance;
    return index_[step].at(values);
}

void StudyPlan::want(std::size_t i, const std::string& output, bool keep) {
    StudyInstance& instance = instances[i];
    const StudyStep& step = study.steps[instance.step];
    if (!instance.outputs.contains(output))
        instance.outputs[output] = file_of(step.name, output, Call(*step.operation).usual_ending(output));
    if (keep) instance.kept.insert(output);
}

void StudyPlan::make_outputs(StudyInstance& instance) {
    const StudyStep& step = study.steps[instance.step];
    if (step.operation == nullptr) return;
    const Call call(*step.operation);
    const auto given = [&](const std::string& name) {
        return std::any_of(instance.inputs.begin(), instance.inputs.end(), [&](const auto& input) { return input.slot == name; });
    };
    for (const Slot* slot : call.parameters().slots()) {
        if (slot->role != Role::output || instance.outputs.contains(slot->name)) continue;
        // An output that updates an input never overwrites a file of the user.
        const bool made = slot->needed || slot->is_positional ||
                          (slot->updated != nullptr && (slot->updated->needed || given(slot->updated->name)));
        if (made) instance.outputs[slot->name] = file_of(step.name, slot->name, call.usual_ending(slot->name));
    }
}

Call StudyPlan::call(const StudyInstance& instance, const Fill& fill) const {
    Call made(*study.steps[instance.step].operation);
    made.set(*instance.options);
    for (const StudyInput& input : instance.inputs) {
        Source source = input.instance == no_instance ? Source{input.file, {}} : fill(input);
        if (source.empty()) made.set_file(input.slot, "none");
        else if (source.object) {
            if (!input.label.empty()) source.object.name = input.label;
            made.set_object(input.slot, std::move(source.object));
        } else made.set_file(input.slot, (input.label.empty() ? "" : input.label + "=") + source.file.string());
    }
    for (const auto& [output, file] : instance.outputs) made.want(output, file);
    return made;
}

std::vector<std::string> StudyPlan::words(const StudyInstance& instance, const FileOf& file, const Path& folder) const {
    std::vector<std::string> all;
    auto input = instance.inputs.begin();
    for (std::string word : instance.program) {
        if (word.empty()) {
            word = file(*input++).string();
        } else {
            for (const auto& [mark, place] : {std::pair("${folder}", folder),
                                              std::pair("${study}", std::filesystem::absolute(study.folder).lexically_normal())})
                for (std::size_t at = word.find(mark); at != std::string::npos; at = word.find(mark, at + place.string().size()))
                    word.replace(at, std::string_view(mark).size(), place.string());
        }
        all.push_back(std::move(word));
    }
    return all;
}

std::vector<std::size_t> StudyPlan::instances_of(std::size_t step) const {
    std::vector<std::size_t> all;
    for (const auto& [values, i] : index_[step]) all.push_back(i);
    std::sort(all.begin(), all.end());
    return all;
}

void StudyPlan::check(const StudyInstance& instance) const {
    const StudyStep& step = study.steps[instance.step];
    if (step.operation == nullptr) return;
    const std::string where = study.at(step.place) + (instance.label.empty() ? "" : " (" + instance.label + ")");
    try {
        Call made = call(instance, [&](const StudyInput& input) {
            return Source{{},
                          Object::of(Promised(), instances[input.instance].outputs.contains(input.output)
                                                     ? instances[input.instance].outputs.at(input.output)
                                                     : input.output)};
        });
        made.check();
        for (const std::string& output : instance.kept) {  // checks that the name is valid for such a file
            Slot& slot = made.slot(output);
            if (slot.fills_folder(0)) continue;
            slot.sources = {{instance.outputs.at(output), {}}};
            slot.check();
        }
    } catch (const Error& error) {
        const std::string at = error.where().empty() || error.where() == step.operation->name ? "" : error.where() + ": ";
        throw Error(error.kind() == ErrorKind::usage ? ErrorKind::input : error.kind(), where,
                    "'" + std::string(step.operation->name) + "': " + at + error.problem(), error.remedy());
    }
}

void StudyPlan::check_outputs() const {
    std::map<Path, std::string> folders;
    for (const StudyInstance& instance : instances) {
        std::map<std::string, std::string> files;
        for (const std::string& output : instance.kept) {
            const std::string& file = instance.outputs.at(output);
            if (const auto [known, is_new] = files.emplace(file, output); !is_new)
                fail_input(study.at(study.steps[instance.step].place + "/keep"),
                           "'" + output + "' and '" + known->second + "' would both be '" + file + "'",
                           "give each a name of its own");
        }
    }
}

}  // namespace ostraka
