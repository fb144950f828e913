#include "ostraka/workflow/plan.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

constexpr std::size_t maximum_instances = 100'000, maximum_inputs = 1'000'000;

/// Placeholder for an output of another instance that does not exist yet.
struct PlaceholderOutput {};

/// A portable folder name for a label; different labels give different names.
std::string folder_name(const std::string& label) {
    std::string name;
    bool changed = label.size() > 120;
    for (const char c : label.substr(0, 100)) {
        const bool is_portable = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                                 c == '_' || c == '.' || c == '=' || c == ',' || c == '+';
        name += is_portable ? c : '_';
        changed = changed || !is_portable;
    }
    return changed ? fmt::format("{}-{}", name, sha256(label).substr(0, 12)) : name;
}

std::string default_file_name(const std::string& step, const std::string& output, const std::string& ending) {
    return (output == "output" ? step : fmt::format("{}-{}", step, output)) + ending;
}

/// Whether a text contains an absolute path or one with "..", also after characters that programs treat as separators.
bool leads_out(const std::string& text) {
    static const std::string separators = "=,:;@";
    std::string part;
    const auto is_outside = [&] {
        const Path path(part);
        return path.is_absolute() ||
               std::any_of(path.begin(), path.end(), [](const Path& component) { return component == ".."; }) ||
               (part.starts_with("-") && part.find('/') != std::string::npos);
    };
    for (const char c : text) {
        if (separators.find(c) == std::string::npos) {
            part += c;
            continue;
        }
        if (is_outside()) return true;
        part.clear();
    }
    return is_outside();
}

}  // namespace

bool is_compatible(Kind available, Kind required) {
    const auto is_any_of = [](Kind kind, std::initializer_list<Kind> kinds) {
        return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    };
    if (available == required || required == Kind::text || available == Kind::text) return true;
    for (const auto& same :
         {std::pair(Kind::mesh, Kind::cage), std::pair(Kind::folder, Kind::collection), std::pair(Kind::table, Kind::report)})
        if (is_any_of(available, {same.first, same.second}) && is_any_of(required, {same.first, same.second})) return true;
    return required == Kind::collection && is_any_of(available, {Kind::mesh, Kind::annotations, Kind::landmarks});
}

std::string StudyInstance::title(const Study& study) const {
    return study.steps[step].name + (label.empty() ? "" : fmt::format(" ({})", label));
}

StudyPlan::StudyPlan(Study study_to_plan) : study(std::move(study_to_plan)), index_(study.steps.size()) {
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
                           fmt::format("the study expands to more than {} instances of steps", maximum_instances),
                           "give fewer values");
        }
    for (std::size_t k = 0; k < count; ++k) {
        std::vector<std::size_t> values(study.parameters.size(), no_instance);
        std::size_t remainder = k;
        for (auto p = varying.rbegin(); p != varying.rend(); ++p) {
            values[*p] = remainder % study.parameters[*p].values.size();
            remainder /= study.parameters[*p].values.size();
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
                   fmt::format("the instances of the study have more than {} inputs", maximum_inputs),
                   "give fewer values, or gather fewer");
}

StudyInstance StudyPlan::make_instance(std::size_t i, const std::vector<std::size_t>& values) {
    const StudyStep& step = study.steps[i];
    StudyInstance instance;
    instance.step = i;
    instance.values = values;
    for (std::size_t p = 0; p < values.size(); ++p)
        if (values[p] != no_instance)
            instance.label += fmt::format("{}{}={}", instance.label.empty() ? "" : ",", study.parameters[p].name,
                                          study.parameters[p].values[values[p]].label);
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
            if (name.empty()) name = default_file_name(step.name, output, call.usual_ending(output));
            require_plain_name(name, study.file.string(), fmt::format("{}/keep/{}", step.place, output));
            if (name == "report.json" || name == "record.json" || name == "output.txt")
                fail_input(study.at(fmt::format("{}/keep/{}", step.place, output)),
                           fmt::format("'{}' is reserved for a file that every step writes", name), "choose another name");
            instance.outputs[output] = name;
            instance.kept.insert(output);
        }
    } else {
        for (const StudySetting& word : step.program) {
            const StudyText text = word.value->IsString() ? study_text(text_of(*word.value), study.at(word.place))
                                                          : StudyText{{scalar_text(*word.value)}};
            const StudyReference* single_reference = text.single();
            const auto is_place = [](const StudyReference& reference) {
                return reference.name == "folder" || reference.name == "study";
            };
            if (single_reference != nullptr && study.parameter(single_reference->name) == nullptr &&
                !is_place(*single_reference)) {
                add_output(instance, {"program", word.value, word.place}, *single_reference, word.place, {});
                instance.program.emplace_back();  // filled in from the inputs in order
            } else {
                for (const StudyReference& reference : text.references())
                    if (study.parameter(reference.name) == nullptr && !is_place(reference))
                        fail_input(study.at(word.place), "a reference to an output of a step cannot be part of a longer text",
                                   "give the reference as a separate word");
                instance.program.push_back(text.parts.empty() ? std::string() : filled(text, instance));
                if (instance.program.back().empty()) fail_input(study.at(word.place), "is empty", "remove it");
                check_word(word, text, instance.program.back());
            }
        }
        if (const std::string& name = instance.program.front(); !study.allow_programs && !is_own_program(name))
            fail_input(study.at(step.place + "/program/0"),
                       fmt::format("starts '{}', which is not a program of the toolkit", printable(name, 60)),
                       "inspect the command with --dry-run; --allow-programs permits it");
        for (const StudySetting& word : step.reads) {
            const Path file =
                (study.folder / filled(study_text(text_of(*word.value), study.at(word.place)), instance)).lexically_normal();
            study.require_readable(file, word.place);
            if (!file_exists(file) && !is_folder(file))
                fail_input(study.at(word.place), fmt::format("'{}' does not exist", file.string()),
                           "names are relative to the study file");
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
    const auto is_from_caller = [&](const StudyReference& reference) {
        const StudyParameter* parameter = study.parameter(reference.name);
        return parameter != nullptr && parameter->by_caller;
    };
    const auto references = text.references();
    if (study.allow_programs || std::any_of(references.begin(), references.end(), is_from_caller)) return;
    const std::size_t equals = filled.starts_with("-") ? filled.find('=') : std::string::npos;
    std::string path_text = filled.substr(equals == std::string::npos ? 0 : equals + 1);
    const auto replace_folder = [&](const std::string& mark) {  // as a prefix, and only as a whole folder name
        if (!path_text.starts_with(mark) || (path_text.size() > mark.size() && path_text[mark.size()] != '/')) return false;
        path_text.erase(0, mark.size());
        return true;
    };
    const bool is_in_study = replace_folder("${study}"), is_in_folder = !is_in_study && replace_folder("${folder}");
    if (is_in_study) study.require_readable(study.folder / ("." + path_text), word.place);
    if (leads_out(is_in_study || is_in_folder ? "." + path_text : path_text) || path_text.find("${") != std::string::npos)
        fail_input(study.at(word.place), fmt::format("'{}' may lead out of the folder of the step", printable(filled, 100)),
                   "use ${folder}, ${study} or an output of a step; --allow-programs permits any path");
}

const JsonValue* StudyPlan::value(const StudyInstance& instance, const StudyReference& reference) const {
    const std::size_t p = study.parameter_index(reference.name);
    if (p == study.parameters.size()) return nullptr;
    const StudyParameter& parameter = study.parameters[p];
    if (parameter.varies && instance.values[p] == no_instance) return nullptr;
    return parameter.values[parameter.varies ? instance.values[p] : 0].find(reference.member);
}

std::string StudyPlan::filled(const StudyText& text, const StudyInstance& instance) const {
    std::string result;
    for (const auto& part : text.parts)
        if (const auto* literal = std::get_if<std::string>(&part)) {
            result += *literal;
        } else {
            const auto& reference = std::get<StudyReference>(part);
            const JsonValue* parameter_value = value(instance, reference);
            result += parameter_value != nullptr ? scalar_text(*parameter_value) : fmt::format("${{{}}}", reference.name);
        }
    return result;
}

void StudyPlan::set_value(StudyInstance& instance, const StudySetting& setting, const JsonValue& setting_value,
                          const std::string& place, const Call& call, JsonValue& options, JsonAllocator& allocator) {
    if (const Slot* slot = call.parameters().slot(setting.name)) return set_slot(instance, setting, setting_value, place, *slot);
    const auto* option = call.parameters().options.find(setting.name);
    if (option == nullptr) {
        try {
            call.no_such_name(setting.name);
        } catch (const Error& error) {
            fail_input(study.at(place), fmt::format("'{}' {}", call.entry().name, error.problem()), error.remedy());
        }
    }
    if (!option->from_files)
        fail_input(study.at(place), fmt::format("'{}' can be set only by the caller, not by a file", setting.name), "remove it");
    const auto resolved = [&](const JsonValue& option_value, const std::string& at) {
        if (!option_value.IsString()) return JsonValue(option_value, allocator);
        const StudyText text = study_text(text_of(option_value), study.at(at));
        for (const StudyReference& reference : text.references())
            if (study.parameter(reference.name) == nullptr)
                fail_input(study.at(at), fmt::format("'{}' is an option, and '{}' is a step", setting.name, reference.name),
                           "use the output of a step as an input");
        if (const StudyReference* single_reference = text.single())
            return JsonValue(*value(instance, *single_reference), allocator);
        return json_string(filled(text, instance), allocator);
    };
    JsonValue resolved_value;
    if (setting_value.IsArray()) {
        resolved_value.SetArray();
        for (rapidjson::SizeType k = 0; k < setting_value.Size(); ++k)
            resolved_value.PushBack(resolved(setting_value[k], fmt::format("{}/{}", place, k)), allocator);
    } else {
        resolved_value = resolved(setting_value, place);
    }
    add_member(options, setting.name, std::move(resolved_value), allocator);
}

void StudyPlan::set_slot(StudyInstance& instance, const StudySetting& setting, const JsonValue& setting_value,
                         const std::string& place, const Slot& slot) {
    if (slot.role == Role::output) {
        if (!setting_value.IsTrue() && !setting_value.IsString())
            fail_input(study.at(place), fmt::format("'{}' is an output", setting.name), "list it in 'keep'");
        fail_input(study.at(place), fmt::format("'{}' is an output and cannot be set in 'with'", setting.name),
                   fmt::format("list it in 'keep': {{\"{}\": \"FILE\"}}", setting.name));
    }
    if (setting_value.IsArray()) {
        if (!slot.repeated && setting_value.Size() != 1)
            fail_input(study.at(place), fmt::format("'{}' takes one file", setting.name), "give one file");
        for (rapidjson::SizeType k = 0; k < setting_value.Size(); ++k)
            set_slot(instance, setting, setting_value[k], fmt::format("{}/{}", place, k), slot);
        return;
    }
    if (!setting_value.IsString())
        fail_input(study.at(place), fmt::format("the value of '{}' is not a file name", setting.name),
                   "give the name of a file, or an output: ${STEP.output}");
    StudyText text = study_text(text_of(setting_value), study.at(place));
    std::string label;
    if (slot.is_named && !text.parts.empty()) {
        auto* literal = std::get_if<std::string>(&text.parts.front());
        const std::size_t equals = literal == nullptr ? std::string::npos : literal->find('=');
        if (literal == nullptr || equals == 0 || equals == std::string::npos)
            fail_input(study.at(place), fmt::format("'{}' needs a name for the file", setting.name), "give NAME=FILE");
        label = literal->substr(0, equals);
        if (*literal = literal->substr(equals + 1); literal->empty()) text.parts.erase(text.parts.begin());
    }
    for (const StudyReference& reference : text.references())
        if (study.parameter(reference.name) == nullptr) {
            if (text.single() == nullptr)
                fail_input(study.at(place), "a reference to an output of a step cannot be part of a longer text",
                           "give ${STEP.output} as the complete value");
            return add_output(instance, setting, reference, place, label);
        }
    const std::string name = filled(text, instance);
    if (name.empty()) fail_input(study.at(place), fmt::format("'{}' is empty", setting.name), "name a file");
    const OperationEntry* operation = study.steps[instance.step].operation;
    // `import` reads point clouds, too.
    const bool may_be_points = slot.kind == Kind::mesh && operation != nullptr && std::string_view(operation->name) == "import";
    instance.inputs.push_back(
        {setting.name,
         label,
         slot.takes_none && name == "none" ? Path() : input_file(name, place, may_be_points ? Kind::point_cloud : slot.kind),
         no_instance,
         {},
         false});
}

Path StudyPlan::input_file(const std::string& name, const std::string& place, Kind kind) const {
    Path file = (study.folder / name).lexically_normal();
    if (is_memory(file)) file = "./" + name;
    study.require_readable(file, place);
    if (!file_exists(file) && !is_folder(file))
        fail_input(study.at(place), fmt::format("'{}' does not exist", file.string()), "names are relative to the study file");
    const auto endings = extensions_of(kind);
    const bool by_ending = kind == Kind::mesh || kind == Kind::cage || kind == Kind::coordinates;
    if (by_ending && std::find(endings.begin(), endings.end(), extension(file)) == endings.end())
        fail_input(study.at(place),
                   fmt::format("the ending of '{}' is not that of a file of type {}", file.filename().string(), to_string(kind)),
                   "use one of the endings " + joined(endings));
    return file;
}

void StudyPlan::add_output(StudyInstance& instance, const StudySetting& setting, const StudyReference& reference,
                           const std::string& place, const std::string& label) {
    const StudyStep& step = study.steps[instance.step];
    const std::size_t source_step = study.step(reference.name);
    const StudyStep& other = study.steps[source_step];
    const bool gathers_all = setting.value->IsObject();
    bool on_disk = false;
    if (step.operation != nullptr && other.operation != nullptr) {
        const Call user_call(*step.operation), source_call(*other.operation);
        const Slot *input_slot = user_call.parameters().slot(setting.name),
                   *output_slot = source_call.parameters().slot(reference.member);
        if (input_slot == nullptr) {
            if (user_call.parameters().options.find(setting.name) == nullptr) {
                try {
                    user_call.no_such_name(setting.name);
                } catch (const Error& error) {
                    fail_input(study.at(place), fmt::format("'{}' {}", step.operation->name, error.problem()), error.remedy());
                }
            }
            fail_input(study.at(place), fmt::format("'{}' is an option", setting.name), "use the output of a step as an input");
        }
        if (input_slot->role != Role::input)
            fail_input(study.at(place), fmt::format("'{}' is an output", setting.name), "list it in 'keep'");
        if (!is_compatible(output_slot->kind, input_slot->kind))
            fail_input(study.at(place),
                       fmt::format("'{}' of '{}' takes {}, but '{}.{}' is {}", setting.name, step.operation->name,
                                   to_string(input_slot->kind), reference.name, reference.member, to_string(output_slot->kind)),
                       "give it an output of that kind");
        if (gathers_all && !input_slot->repeated && input_slot->kind != Kind::collection)
            fail_input(study.at(place), fmt::format("'{}' takes one {}", setting.name, to_string(input_slot->kind)),
                       fmt::format("give it one: ${{{}.{}}}", reference.name, reference.member));
        on_disk = output_slot->kind == Kind::mesh && input_slot->reads_annotations_beside;
        if (on_disk && !other.keep.contains(reference.member))
            fail_input(study.at(place),
                       fmt::format("'{}' also reads the annotations next to a file (NAME.ant.json), but '{}.{}' is not kept",
                                   step.operation->name, reference.name, reference.member),
                       fmt::format(
                           "add \"keep\": {{\"{1}\": \"NAME.ply\"}} to step '{0}', and keep its annotations as \"NAME.ant.json\"",
                           reference.name, reference.member));
    }
    const bool keep = step.operation == nullptr;  // programs read files
    const auto add = [&](std::size_t source) {
        if (other.operation != nullptr) request_output(source, reference.member, keep);
        instance.inputs.push_back({setting.name, label, {}, source, reference.member, on_disk});
    };
    if (!gathers_all) return add(instance_of(source_step, instance));
    for (const auto& [values, i] : index_[source_step]) {
        bool agrees = true;
        for (std::size_t p = 0; p < values.size(); ++p)
            agrees = agrees && (values[p] == no_instance || instance.values[p] == no_instance || values[p] == instance.values[p]);
        if (agrees) add(i);
    }
}

std::size_t StudyPlan::instance_of(std::size_t step, const StudyInstance& user) const {
    std::vector<std::size_t> values = user.values;
    for (std::size_t p = 0; p < values.size(); ++p)
        if (!study.steps[step].parameters[p]) values[p] = no_instance;
    return index_[step].at(values);
}

void StudyPlan::request_output(std::size_t i, const std::string& output, bool keep) {
    StudyInstance& instance = instances[i];
    const StudyStep& step = study.steps[instance.step];
    if (!instance.outputs.contains(output))
        instance.outputs[output] = default_file_name(step.name, output, Call(*step.operation).usual_ending(output));
    if (keep) instance.kept.insert(output);
}

void StudyPlan::make_outputs(StudyInstance& instance) {
    const StudyStep& step = study.steps[instance.step];
    if (step.operation == nullptr) return;
    const Call call(*step.operation);
    const auto has_input = [&](const std::string& name) {
        return std::any_of(instance.inputs.begin(), instance.inputs.end(), [&](const auto& input) { return input.slot == name; });
    };
    for (const Slot* slot : call.parameters().slots()) {
        if (slot->role != Role::output || instance.outputs.contains(slot->name)) continue;
        // An output that updates an input never overwrites a file of the user.
        const bool is_written = slot->needed || slot->is_positional ||
                                (slot->updated != nullptr && (slot->updated->needed || has_input(slot->updated->name)));
        if (is_written) instance.outputs[slot->name] = default_file_name(step.name, slot->name, call.usual_ending(slot->name));
    }
}

Call StudyPlan::call(const StudyInstance& instance, const Fill& fill) const {
    Call filled_call(*study.steps[instance.step].operation);
    filled_call.set(*instance.options);
    for (const StudyInput& input : instance.inputs) {
        Source source = input.instance == no_instance ? Source{input.file, {}} : fill(input);
        if (source.empty()) filled_call.set_file(input.slot, "none");
        else if (source.object) {
            if (!input.label.empty()) source.object.name = input.label;
            filled_call.set_object(input.slot, std::move(source.object));
        } else filled_call.set_file(input.slot, (input.label.empty() ? "" : input.label + "=") + source.file.string());
    }
    for (const auto& [output, file] : instance.outputs) filled_call.want(output, file);
    return filled_call;
}

std::vector<std::string> StudyPlan::words(const StudyInstance& instance, const FileOf& file, const Path& folder) const {
    std::vector<std::string> command_words;
    auto input = instance.inputs.begin();
    for (std::string word : instance.program) {
        if (word.empty()) {
            word = file(*input++).string();
        } else {
            for (const auto& [placeholder, place] :
                 {std::pair("${folder}", folder),
                  std::pair("${study}", std::filesystem::absolute(study.folder).lexically_normal())})
                for (std::size_t at = word.find(placeholder); at != std::string::npos;
                     at = word.find(placeholder, at + place.string().size()))
                    word.replace(at, std::string_view(placeholder).size(), place.string());
        }
        command_words.push_back(std::move(word));
    }
    return command_words;
}

std::vector<std::size_t> StudyPlan::instances_of(std::size_t step) const {
    std::vector<std::size_t> step_instances;
    for (const auto& [values, i] : index_[step]) step_instances.push_back(i);
    std::sort(step_instances.begin(), step_instances.end());
    return step_instances;
}

void StudyPlan::check(const StudyInstance& instance) const {
    const StudyStep& step = study.steps[instance.step];
    if (step.operation == nullptr) return;
    const std::string where = study.at(step.place) + (instance.label.empty() ? "" : fmt::format(" ({})", instance.label));
    try {
        Call checked_call = call(instance, [&](const StudyInput& input) {
            return Source{{},
                          Object::of(PlaceholderOutput(), instances[input.instance].outputs.contains(input.output)
                                                              ? instances[input.instance].outputs.at(input.output)
                                                              : input.output)};
        });
        checked_call.check();
        for (const std::string& output : instance.kept) {  // checks that the name is valid for such a file
            Slot& slot = checked_call.slot(output);
            if (slot.fills_folder(0)) continue;
            slot.sources = {{instance.outputs.at(output), {}}};
            slot.check();
        }
    } catch (const Error& error) {
        const std::string at = error.where().empty() || error.where() == step.operation->name ? "" : error.where() + ": ";
        throw Error(error.kind() == ErrorKind::usage ? ErrorKind::input : error.kind(), where,
                    fmt::format("'{}': {}{}", step.operation->name, at, error.problem()), error.remedy());
    }
}

void StudyPlan::check_outputs() const {
    std::map<Path, std::string> folders;
    for (const StudyInstance& instance : instances) {
        std::map<std::string, std::string> files;
        for (const std::string& output : instance.kept) {
            const std::string& file = instance.outputs.at(output);
            if (const auto [first_output, is_new] = files.emplace(file, output); !is_new)
                fail_input(study.at(study.steps[instance.step].place + "/keep"),
                           fmt::format("'{}' and '{}' would both be '{}'", output, first_output->second, file),
                           "give each its own file name");
        }
    }
}

}  // namespace ostraka
