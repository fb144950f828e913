#include "framework/call_state.h"

#include "ostraka/core/memory.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/files/transaction.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

namespace ostraka {

Slot& Parameters::input(std::string name, Kind kind, Slot& slot, std::string help) {
    if (this->slot(name) != nullptr) throw std::logic_error(fmt::format("'{}' is declared twice", name));
    slot.name = std::move(name);
    slot.kind = kind;
    slot.role = Role::input;
    slot.help = std::move(help);
    slots_.push_back(&slot);
    slot.declare_options(options);
    return slot;
}

Slot& Parameters::output(std::string name, Kind kind, Slot& slot, std::string help) {
    input(std::move(name), kind, slot, std::move(help)).role = Role::output;
    return slot;
}

Slot* Parameters::slot(const std::string& name) const {
    const auto match = std::find_if(slots_.begin(), slots_.end(), [&](const Slot* slot) { return slot->name == name; });
    return match == slots_.end() ? nullptr : *match;
}

bool Parameters::in_some_order(const std::string& name) const {
    return std::any_of(orders.begin(), orders.end(),
                       [&](const auto& order) { return std::find(order.begin(), order.end(), name) != order.end(); });
}

bool Parameters::updated_in_place(const Slot& input) const {
    return std::any_of(slots_.begin(), slots_.end(), [&](const Slot* slot) {
        return slot->updated == &input && !slot->sources.empty() && slot->sources.front().in_place;
    });
}

Operation::~Operation() = default;

Call::Call(const OperationEntry& entry) : entry_(&entry), operation_(entry.make()) {
    operation_->declare(parameters_);
    for (const Slot* slot : parameters_.slots())
        if (parameters_.options.find(slot->name) != nullptr)
            throw std::logic_error(fmt::format("{} declares '{}' twice", entry.name, slot->name));
    if (!parameters_.orders.empty()) return;
    std::vector<std::string> order;
    for (const Slot* slot : parameters_.slots())
        if (slot->is_positional) order.push_back(slot->name);
    for (const Option& option : parameters_.options)
        if (option.is_positional) order.push_back(option.name);
    parameters_.orders.push_back(std::move(order));
}

Call::~Call() = default;
Call::Call(Call&&) noexcept = default;

namespace {
/// The present name of an option that had another name before version 0.2; the name itself if it had no other.
std::string present_name(const std::string& name, const std::vector<std::string>& names) {
    static const std::map<std::string, std::string> renamed{
        {"attributes", "check-attributes"},   {"carry", "colour-neighbours"}, {"deep", "sixteen-bit"},
        {"facet-edge", "facet-crease-angle"}, {"faint", "min-contrast"},      {"lying", "min-on-template"},
        {"none", "no-fixed-ratios"},          {"ratio", "max-difference"},    {"sheet", "several-per-page"},
        {"slack", "min-tolerance"},           {"wide", "background-scale"}};
    const auto entry = renamed.find(name);
    if (entry != renamed.end() && std::find(names.begin(), names.end(), entry->second) != names.end()) return entry->second;
    std::string present = "-" + name + "-";
    for (const auto& [word, present_word] :
         {std::pair<std::string, const char*>("-least-", "-min-"), {"-most-", "-max-"}, {"-strangers-", "-out-of-class-"}})
        if (const auto at = present.find(word); at != std::string::npos) present.replace(at, word.size(), present_word);
    return present.substr(1, present.size() - 2);
}
}  // namespace

void Call::no_such_name(const std::string& name, const std::vector<std::string>& flags) const {
    std::vector<std::string> names = flags;
    for (const Option& option : parameters_.options) names.push_back(option.name);
    for (const Slot* slot : parameters_.slots()) names.push_back(slot->name);
    const std::string nearest = nearest_name(present_name(name, names), names);
    throw Error(ErrorKind::usage, entry_->name, fmt::format("has no option '{}'", printable(name, 60)),
                nearest.empty()                     ? fmt::format("'ostraka {} --help' shows them", entry_->name)
                : nearest == name && !flags.empty() ? "options begin with --"
                                                    : fmt::format("did you mean '{}'?", nearest));
}

Option& Call::option(const std::string& name) {
    Option* match = parameters_.options.find(name);
    if (match == nullptr) no_such_name(name);
    return *match;
}

Slot& Call::slot(const std::string& name) {
    Slot* match = parameters_.slot(name);
    if (match == nullptr) no_such_name(name);
    return *match;
}

namespace {
/// Runs `work`; errors about options name the operation.
template <class Work>
void in_operation(const char* name, const Work& work) {
    try {
        work();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::usage || !error.where().empty()) throw;
        throw Error(error.kind(), name, error.problem(), error.remedy());
    }
}
}  // namespace

void Call::set(const std::string& name, const std::string& value) {
    in_operation(entry_->name, [&] {
        Option& target = option(name);
        if (target.type() != OptionType::text && target.type() != OptionType::choice && target.type() != OptionType::texts)
            throw Error(ErrorKind::usage, "", fmt::format("option {} is the text '{}'", name, printable(value, 60)),
                        "use " + target.allowed());
        if (target.type() == OptionType::texts && target.given) {
            auto words = target.texts();
            words.push_back(value);
            target.set(words);
        } else {
            target.set(std::vector{value});
        }
    });
}
void Call::set(const std::string& name, bool value) {
    in_operation(entry_->name, [&] { option(name).set(value); });
}
void Call::set(const std::string& name, double value) {
    in_operation(entry_->name, [&] {
        Option& target = option(name);
        if (target.type() == OptionType::integer && value == static_cast<double>(static_cast<std::int64_t>(value)))
            target.set(static_cast<std::int64_t>(value));
        else target.set(value);
    });
}

void Call::set_file(const std::string& name, const Path& file) {
    Slot& target_slot = slot(name);
    if (!target_slot.sources.empty() && !target_slot.repeated)
        throw Error(ErrorKind::usage, entry_->name, name + " is given twice", "give it once");
    if (file.empty()) throw Error(ErrorKind::usage, entry_->name, name + " is empty", "name a file");
    if (target_slot.takes_none && file == "none") {
        target_slot.sources.emplace_back();
        return;
    }
    if (!target_slot.is_named) {
        target_slot.sources.push_back({file, {}});
        return;
    }
    const std::string word = file.string();
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == word.size())
        throw Error(ErrorKind::usage, entry_->name, fmt::format("{} is '{}'", name, printable(word, 60)), "give NAME=FILE");
    Source& source = target_slot.sources.emplace_back();
    source.file = word.substr(equals + 1);
    source.label = word.substr(0, equals);
}

void Call::set_object(const std::string& name, Object object) {
    Slot& target_slot = slot(name);
    if (target_slot.role != Role::input)
        throw Error(ErrorKind::usage, entry_->name, name + " is an output", "request it with want");
    if (!target_slot.sources.empty() && !target_slot.repeated)
        throw Error(ErrorKind::usage, entry_->name, name + " is given twice", "give it once");
    if (!object) throw Error(ErrorKind::usage, entry_->name, name + " is not an object", "give a " + to_string(target_slot.kind));
    if (object.name.empty()) object.name = name;
    target_slot.sources.push_back({{}, std::move(object)});
}

void Call::want(const std::string& name, const std::string& object_name) {
    Slot& target_slot = slot(name);
    if (target_slot.role != Role::output)
        throw Error(ErrorKind::usage, entry_->name, name + " is an input", "give it a file or an object");
    if (target_slot.sources.empty()) target_slot.sources.emplace_back();
    target_slot.sources.front().object.name = object_name;
}

void Call::set(const JsonValue& values, const std::string& where) {
    if (!values.IsObject()) throw Error(ErrorKind::usage, where, "is not an object", "give names and values");
    const auto fail_type = [&](const std::string& name, const std::string& allowed) {
        throw Error(ErrorKind::usage, where.empty() ? entry_->name : where, fmt::format("'{}' has a value of another type", name),
                    "use " + allowed);
    };
    for (const auto& member : values.GetObject()) {
        const std::string name = member.name.GetString();
        const JsonValue& value = member.value;
        if (Slot* target_slot = parameters_.slot(name)) {
            if (value.IsString()) set_file(name, value.GetString());
            else if (value.IsTrue() && target_slot->role == Role::output) want(name);
            else if (value.IsArray())
                for (const auto& element : value.GetArray())
                    if (element.IsString()) set_file(name, element.GetString());
                    else fail_type(name, "names of files");
            else fail_type(name, target_slot->role == Role::output ? "the name of a file, or true" : "the name of a file");
            continue;
        }
        Option& target_option = option(name);
        if (value.IsBool()) set(name, value.GetBool());
        else if (value.IsInt64()) in_operation(entry_->name, [&] { target_option.set(value.GetInt64()); });
        else if (value.IsNumber()) in_operation(entry_->name, [&] { target_option.set(value.GetDouble()); });
        else if (value.IsString()) set(name, std::string(value.GetString(), value.GetStringLength()));
        else if (value.IsArray()) {
            std::vector<double> numbers;
            std::vector<std::string> texts;
            for (const auto& element : value.GetArray())
                if (element.IsNumber()) numbers.push_back(element.GetDouble());
                else if (element.IsString()) texts.emplace_back(element.GetString());
                else fail_type(name, target_option.allowed());
            if (!numbers.empty() && !texts.empty()) fail_type(name, target_option.allowed());
            in_operation(entry_->name, [&] {
                if (!texts.empty() && target_option.type() != OptionType::texts) fail_type(name, target_option.allowed());
                if (!numbers.empty() && target_option.type() == OptionType::texts) fail_type(name, target_option.allowed());
                if (!texts.empty()) target_option.set(texts);
                else target_option.set(numbers);
            });
        } else {
            fail_type(name, target_option.allowed());
        }
    }
}

namespace {
/// Refuses a mesh file where a JSON document is expected (arguments in the wrong order).
void refuse_mesh(const Slot& slot, const Path& file) {
    constexpr std::array documents{Kind::annotations, Kind::graph, Kind::edit, Kind::recipe, Kind::rules};
    const auto mesh_extensions = extensions_of(Kind::mesh);
    if (std::find(documents.begin(), documents.end(), slot.kind) == documents.end() ||
        std::find(mesh_extensions.begin(), mesh_extensions.end(), extension(file)) == mesh_extensions.end())
        return;
    fail_input(file.string(), "has the name of a mesh, but is given as: " + slot.help, "check the order of the files");
}
}  // namespace

void Call::check_given(const std::function<bool(const Path&)>& will_exist) const {
    for (const Option& option : parameters_.options)
        if (option.needed && !option.given)
            throw Error(ErrorKind::usage, entry_->name, fmt::format("option {} is missing", option.name),
                        "give the " + option.help);
    std::vector<Path> inputs, outputs;
    for (const Slot* slot : parameters_.slots()) {
        if (slot->needed && slot->sources.empty() && slot->role == Role::input && !slot->may_be_new)
            throw Error(ErrorKind::usage, entry_->name, slot->name + " is missing", "give the " + slot->help);
        if (slot->role == Role::output) slot->check();
        for (std::size_t i = 0; i < slot->sources.size(); ++i) {
            const Path& file = slot->sources[i].file;
            if (file.empty()) continue;
            if (slot->role == Role::input) {
                if (!parameters_.updated_in_place(*slot)) inputs.push_back(file);
            } else if (!slot->fills_folder(i)) {
                outputs.push_back(file);
            }
        }
    }
    check_outputs(inputs, outputs);
    for (const Slot* slot : parameters_.slots())
        for (const Source& source : slot->sources)
            if (slot->role == Role::input) refuse_mesh(*slot, source.file);
    in_operation(entry_->name, [&] {
        for (const auto& check : parameters_.checks) check();
        operation_->check();
    });
    for (const Slot* slot : parameters_.slots())
        for (const Source& source : slot->sources)
            if (slot->role == Role::input && !source.file.empty() && slot->kind != Kind::collection && !is_folder(source.file) &&
                (!slot->may_be_new || file_exists(source.file)) &&
                (!will_exist || file_exists(source.file) || !will_exist(source.file)))
                check_readable(source.file);
}

void Call::complete() {
    for (Slot* slot : parameters_.slots()) {
        if (slot->updated != nullptr && slot->sources.empty()) {
            const bool given = static_cast<bool>(*slot->updated);
            if (given) slot->sources.push_back({slot->updated->sources.front().file, {}, true});
            else if (slot->updated->needed) slot->sources.emplace_back();
        }
        if (slot->role == Role::output && slot->needed && slot->sources.empty()) slot->sources.emplace_back();
    }
}

void Call::check(const std::function<bool(const Path&)>& will_exist) {
    complete();
    in_operation(entry_->name, [&] { parameters_.options.check(""); });
    check_given(will_exist);
}

Report Call::run(Context& context, const std::function<void(const Report&)>& before_commit) {
    check();
    for (Slot* slot : parameters_.slots()) slot->context = &context;
    Report report({entry_->name, {}, {}}, parameters_.report);
    report.on_note = context.on_note;
    Context::CallState call_state{entry_->name, &parameters_, &report};
    struct RestoreCall {
        Context& context;
        Context::CallState* outer;
        ~RestoreCall() { context.call_ = outer; }
    } restore_call{context, context.call_};
    context.call_ = &call_state;
    const WatchScope watch(&context.watch);
    check_cancelled();
    // If a memory limit is set, refuse work that is estimated to exceed it.
    if (context.watch.memory_limit > 0)
        require_memory(operation_->memory_needed(input_bytes()), fmt::format("'{}'", entry_->name),
                       "allow more, or use smaller meshes");
    OutputTransaction outputs;
    operation_->run(context, report);
    report.set_provenance(context.provenance());
    context.read_ = call_state.read;
    check_cancelled();
    if (before_commit) before_commit(report);
    std::vector<Path> inputs;
    for (const auto& entry : call_state.read) inputs.push_back(entry.file);
    for (const Slot* slot : parameters_.slots())
        for (const Source& source : slot->sources)
            if (slot->role == Role::input) inputs.push_back(source.file);
    const ProtectedInputs protected_inputs(std::move(inputs));
    outputs.commit();
    for (Slot* slot : parameters_.slots()) slot->finish();
    return report;
}

double Call::input_bytes() const {
    double bytes = 0;
    for (const Slot* slot : parameters_.slots())
        for (const Source& source : slot->sources)
            if (slot->role == Role::input && !source.file.empty()) bytes += static_cast<double>(size_of_file(source.file));
    return bytes;
}

std::string Call::usual_ending(const std::string& output) const {
    const Slot* match = parameters_.slot(output);
    if (match == nullptr) no_such_name(output);
    if (dynamic_cast<const FolderOutput*>(match) != nullptr) return {};
    if (const auto* file = dynamic_cast<const FileOutput*>(match); file != nullptr && !file->extension_.empty())
        return file->extension_;
    if (const auto endings = extensions_of(match->kind); !endings.empty()) return endings.front();
    return dynamic_cast<const ValuesOutput*>(match) != nullptr ? ".npy" : ".json";
}

const Object& Call::object(const std::string& name, std::size_t i) const {
    const Slot* match = parameters_.slot(name);
    if (match == nullptr) no_such_name(name);
    if (i >= match->size() || !match->sources[i].object)
        throw Error(ErrorKind::usage, entry_->name, name + " holds no object", "it was not requested, or was written to a file");
    return match->sources[i].object;
}

}  // namespace ostraka
