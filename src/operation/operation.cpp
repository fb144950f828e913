#include "ostraka/operation/operation.h"

#include "ostraka/core/nearest_name.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

namespace ostraka {

// ---- declarations ----

Slot& Parameters::input(std::string name, Kind kind, Slot& slot, std::string help) {
    if (this->slot(name) != nullptr) throw std::logic_error("'" + name + "' is declared twice");
    slot.name = std::move(name);
    slot.kind = kind;
    slot.role = Role::input;
    slot.help = std::move(help);
    slots_.push_back(&slot);
    slot.describe(options);
    return slot;
}

Slot& Parameters::output(std::string name, Kind kind, Slot& slot, std::string help) {
    input(std::move(name), kind, slot, std::move(help)).role = Role::output;
    return slot;
}

Slot* Parameters::slot(const std::string& name) const {
    const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const Slot* slot) { return slot->name == name; });
    return found == slots_.end() ? nullptr : *found;
}

bool Parameters::updated_in_place(const Slot& input) const {
    return std::any_of(slots_.begin(), slots_.end(), [&](const Slot* slot) {
        return slot->updated == &input && !slot->sources.empty() && slot->sources.front().in_place;
    });
}

Operation::~Operation() = default;

// ---- context ----

/// A call under way.
struct Context::Run {
    std::string command;
    const Parameters* parameters = nullptr;
    Report* report = nullptr;
    std::vector<ReadRecord::Entry> read;                                   ///< files, in the order of reading
    std::map<std::pair<const Slot*, std::size_t>, std::string> checksums;  ///< of objects in memory
    std::map<std::tuple<const Slot*, std::size_t, std::type_index, std::string>, std::shared_ptr<const void>> loaded;
    std::vector<std::pair<std::string, std::string>> noted;       ///< so that each note of a file comes once
    std::vector<std::pair<std::string, std::string>> named = {};  ///< name and checksum of inputs that are read elsewhere

    /// The checksum of the i-th object of a slot: what it says itself, or that of the file that it is or would be.
    void know(const Slot& slot, std::size_t i) {
        const Object& object = slot.sources[i].object;
        std::string& sum = checksums[{&slot, i}];
        if (!sum.empty()) return;
        sum = object.sha256;
        if (sum.empty() && object.write) {
            static std::atomic<std::size_t> count{0};
            const Path file = "memory:.checksum/" + std::to_string(++count) + "/" + Path(object.name).filename().string();
            OutputTransaction own;
            object.write(file);
            own.commit();
            sum = sha256_of_file(file);
            for (const std::string& beside : files_in(file.parent_path()))  // such as the header of coordinates
                if (beside != file.filename()) named.emplace_back(beside, sha256_of_file(file.parent_path() / beside));
            forget_memory(file.parent_path());
        } else if (const auto bytes = object.as<std::string>(); sum.empty() && bytes) {
            sum = sha256(*bytes);
        } else if (const auto document = object.as<Json>(); sum.empty() && document) {
            sum = sha256(to_text(*document));
        }
    }

    void add(const std::vector<ReadRecord::Entry>& files) {
        for (const auto& entry : files)
            if (std::none_of(read.begin(), read.end(), [&](const auto& known) { return known.file == entry.file; }))
                read.push_back(entry);
    }
};

struct Context::Kept {
    struct File {
        ReadRecord::Entry entry;
        std::uintmax_t size = 0;
        std::filesystem::file_time_type time;
        [[nodiscard]] bool unchanged() const {
            std::error_code code;
            return is_memory(entry.file) || (std::filesystem::file_size(entry.file, code) == size &&
                                             std::filesystem::last_write_time(entry.file, code) == time);
        }
    };
    struct Entry {
        std::vector<File> files;
        std::shared_ptr<const void> data;
    };
    std::map<std::tuple<std::string, std::type_index, std::string>, Entry> objects;
};

Context::Context() : kept_(std::make_unique<Kept>()) {}

Context::~Context() {
    for (const Path& file : memory_) forget_memory(file);
}

Provenance Context::provenance() const {
    if (run_ == nullptr) throw std::logic_error("no operation is under way");
    Provenance provenance;
    provenance.command = run_->command;
    provenance.options = run_->parameters->options.values();
    std::erase_if(provenance.options, [](const auto& option) { return option.second.empty(); });
    std::vector<Path> listed;
    for (const Slot* slot : run_->parameters->slots()) {
        if (slot->role != Role::input) continue;
        for (std::size_t i = 0; i < slot->sources.size(); ++i) {
            const Source& source = slot->sources[i];
            if (source.object.as<Path>()) continue;  // a folder, whose files are recorded
            if (source.object) {
                run_->know(*slot, i);
                provenance.inputs.emplace_back(Path(source.object.name).filename().string(), run_->checksums.at({slot, i}));
                continue;
            }
            listed.push_back(source.file);
            const std::string called = (source.label.empty() ? "" : source.label + "=") + source.file.filename().string();
            const auto read =
                std::find_if(run_->read.begin(), run_->read.end(), [&](const auto& entry) { return entry.file == source.file; });
            if (read == run_->read.end()) {  // not read yet, or a folder, whose files are read
                if (!file_exists(source.file)) continue;
                run_->read.push_back({source.file, sha256_of_file(source.file)});
                provenance.inputs.emplace_back(called, run_->read.back().sha256);
            } else {
                provenance.inputs.emplace_back(called, read->sha256);
            }
        }
    }
    for (const auto& entry : run_->read)
        if (!is_memory(entry.file) && std::find(listed.begin(), listed.end(), entry.file) == listed.end())
            provenance.inputs.emplace_back(entry.file.filename().string(), entry.sha256);
    provenance.inputs.insert(provenance.inputs.end(), run_->named.begin(), run_->named.end());
    return provenance;
}

std::shared_ptr<const void> Context::load(const Slot& slot, std::size_t i, std::type_index type, const std::string& key,
                                          const Read& read) {
    if (run_ == nullptr) throw std::logic_error("no operation is under way");
    if (i >= slot.sources.size()) throw std::logic_error("nothing was given for " + slot.name);
    const auto place = std::tuple(&slot, i, type, key);
    if (const auto known = run_->loaded.find(place); known != run_->loaded.end()) return known->second;
    check_cancelled();
    const Source& source = slot.sources[i];
    if (source.object) run_->know(slot, i);
    const bool shared = keep_objects && !source.object;
    const auto name = std::tuple(source.file.string(), type, key);
    if (shared)
        if (const auto known = kept_->objects.find(name); known != kept_->objects.end()) {
            const auto& files = known->second.files;
            if (std::all_of(files.begin(), files.end(), [](const Kept::File& file) { return file.unchanged(); })) {
                for (const auto& file : files) run_->add({file.entry});
                return run_->loaded[place] = known->second.data;
            }
            kept_->objects.erase(known);
        }
    std::vector<ReadRecord::Entry> files;
    std::shared_ptr<const void> data;
    {
        const ReadRecord record;
        data = read(source.file);
        files = record.files;
    }
    run_->add(files);
    if (shared) {
        Kept::Entry entry{{}, data};
        for (const auto& file : files) {
            std::error_code code;
            if (is_memory(file.file)) entry.files.push_back({file, 0, {}});
            else
                entry.files.push_back(
                    {file, std::filesystem::file_size(file.file, code), std::filesystem::last_write_time(file.file, code)});
        }
        kept_->objects[name] = std::move(entry);
    }
    return run_->loaded[place] = data;
}

void Context::record(const std::function<void()>& read) {
    const ReadRecord record;
    read();
    run_->add(record.files);
}

void Context::record_input(const std::string& name, const std::string& sha256) { run_->named.emplace_back(name, sha256); }

void Context::record_object(const Slot& slot, std::size_t i, const std::string& sha256) { run_->checksums[{&slot, i}] = sha256; }

void Context::note(const std::string& text) { run_->report->note(text); }

void Context::notes(const std::string& file, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
        if (std::find(run_->noted.begin(), run_->noted.end(), std::pair(file, text)) != run_->noted.end()) continue;
        run_->noted.emplace_back(file, text);
        run_->report->note(file.empty() ? text : file + ": " + text);
    }
}

Path Context::memory(const std::string& name) {
    static std::atomic<std::size_t> count{0};
    const Path folder = "memory:" + std::to_string(++count);
    memory_.push_back(folder);
    return folder / name;
}

void Context::check_output(const Path& file) const {
    std::vector<Path> inputs;
    for (const auto& entry : run_->read) inputs.push_back(entry.file);
    for (const Slot* slot : run_->parameters->slots())
        if (run_->parameters->updated_in_place(*slot)) std::erase(inputs, slot->sources.front().file);
    ostraka::check_outputs(inputs, {file});
}

void Context::check_outputs(const std::vector<Path>& further) const {
    std::vector<Path> inputs, outputs;
    for (const auto& entry : run_->read) inputs.push_back(entry.file);
    for (const Slot* slot : run_->parameters->slots())
        if (run_->parameters->updated_in_place(*slot)) std::erase(inputs, slot->sources.front().file);
    for (const Slot* slot : run_->parameters->slots())
        if (dynamic_cast<const FolderOutput*>(slot) == nullptr && !run_->parameters->updated_in_place(*slot))
            for (const Source& source : slot->sources) (slot->role == Role::input ? inputs : outputs).push_back(source.file);
    outputs.insert(outputs.end(), further.begin(), further.end());
    ostraka::check_outputs(inputs, outputs);
}

// ---- calls ----

Call::Call(const OperationEntry& entry) : entry_(&entry), operation_(entry.make()) {
    operation_->describe(parameters_);
    for (const Slot* slot : parameters_.slots())
        if (parameters_.options.find(slot->name) != nullptr)
            throw std::logic_error(std::string(entry.name) + " declares '" + slot->name + "' twice");
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

void Call::no_such_name(const std::string& name) const {
    std::vector<std::string> names;
    for (const Option& option : parameters_.options) names.push_back(option.name);
    for (const Slot* slot : parameters_.slots()) names.push_back(slot->name);
    const std::string near = nearest_name(name, names);
    throw Error(ErrorKind::usage, entry_->name, "has no option '" + printable(name, 60) + "'",
                near.empty() ? "'ostraka " + std::string(entry_->name) + " --help' shows them" : "did you mean '" + near + "'?");
}

Option& Call::option(const std::string& name) {
    Option* found = parameters_.options.find(name);
    if (found == nullptr) no_such_name(name);
    return *found;
}

Slot& Call::slot(const std::string& name) {
    Slot* found = parameters_.slot(name);
    if (found == nullptr) no_such_name(name);
    return *found;
}

namespace {
/// Errors of options name the operation.
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
        Option& known = option(name);
        if (known.type() != OptionType::text && known.type() != OptionType::choice && known.type() != OptionType::texts)
            throw Error(ErrorKind::usage, "", "option " + name + " is the text '" + printable(value, 60) + "'",
                        "use " + known.allowed());
        if (known.type() == OptionType::texts && known.given) {
            auto words = known.texts();
            words.push_back(value);
            known.set(words);
        } else {
            known.set(std::vector{value});
        }
    });
}
void Call::set(const std::string& name, bool value) {
    in_operation(entry_->name, [&] { option(name).set(value); });
}
void Call::set(const std::string& name, double value) {
    in_operation(entry_->name, [&] {
        Option& known = option(name);
        if (known.type() == OptionType::integer && value == static_cast<double>(static_cast<std::int64_t>(value)))
            known.set(static_cast<std::int64_t>(value));
        else known.set(value);
    });
}

void Call::set_file(const std::string& name, const Path& file) {
    Slot& known = slot(name);
    if (!known.sources.empty() && !known.repeated)
        throw Error(ErrorKind::usage, entry_->name, name + " is given twice", "give it once");
    if (file.empty()) throw Error(ErrorKind::usage, entry_->name, name + " is empty", "name a file");
    if (known.takes_none && file == "none") {
        known.sources.emplace_back();
        return;
    }
    if (!known.is_named) {
        known.sources.push_back({file, {}});
        return;
    }
    const std::string word = file.string();
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == word.size())
        throw Error(ErrorKind::usage, entry_->name, name + " is '" + printable(word, 60) + "'", "give NAME=FILE");
    Source& source = known.sources.emplace_back();
    source.file = word.substr(equals + 1);
    source.label = word.substr(0, equals);
}

void Call::set_object(const std::string& name, Object object) {
    Slot& known = slot(name);
    if (known.role != Role::input) throw Error(ErrorKind::usage, entry_->name, name + " is an output", "ask for it with want");
    if (!known.sources.empty() && !known.repeated)
        throw Error(ErrorKind::usage, entry_->name, name + " is given twice", "give it once");
    if (!object) throw Error(ErrorKind::usage, entry_->name, name + " is no object", "give a " + to_string(known.kind));
    if (object.name.empty()) object.name = name;
    known.sources.push_back({{}, std::move(object)});
}

void Call::want(const std::string& name, const std::string& called) {
    Slot& known = slot(name);
    if (known.role != Role::output)
        throw Error(ErrorKind::usage, entry_->name, name + " is an input", "give it a file or an object");
    if (known.sources.empty()) known.sources.emplace_back();
    known.sources.front().object.name = called;
}

void Call::set(const JsonValue& values, const std::string& where) {
    if (!values.IsObject()) throw Error(ErrorKind::usage, where, "is no object", "give names and values");
    const auto wrong = [&](const std::string& name, const std::string& allowed) {
        throw Error(ErrorKind::usage, where.empty() ? entry_->name : where, "'" + name + "' has a value of another type",
                    "use " + allowed);
    };
    for (const auto& member : values.GetObject()) {
        const std::string name = member.name.GetString();
        const JsonValue& value = member.value;
        if (Slot* known = parameters_.slot(name)) {
            if (value.IsString()) set_file(name, value.GetString());
            else if (value.IsTrue() && known->role == Role::output) want(name);
            else if (value.IsArray())
                for (const auto& one : value.GetArray())
                    if (one.IsString()) set_file(name, one.GetString());
                    else wrong(name, "names of files");
            else wrong(name, known->role == Role::output ? "the name of a file, or true" : "the name of a file");
            continue;
        }
        Option& known = option(name);
        if (value.IsBool()) set(name, value.GetBool());
        else if (value.IsInt64()) in_operation(entry_->name, [&] { known.set(value.GetInt64()); });
        else if (value.IsNumber()) in_operation(entry_->name, [&] { known.set(value.GetDouble()); });
        else if (value.IsString()) set(name, std::string(value.GetString(), value.GetStringLength()));
        else if (value.IsArray()) {
            std::vector<double> numbers;
            std::vector<std::string> texts;
            for (const auto& one : value.GetArray())
                if (one.IsNumber()) numbers.push_back(one.GetDouble());
                else if (one.IsString()) texts.emplace_back(one.GetString());
                else wrong(name, known.allowed());
            if (!numbers.empty() && !texts.empty()) wrong(name, known.allowed());
            in_operation(entry_->name, [&] {
                if (!texts.empty() && known.type() != OptionType::texts) wrong(name, known.allowed());
                if (!numbers.empty() && known.type() == OptionType::texts) wrong(name, known.allowed());
                if (!texts.empty()) known.set(texts);
                else known.set(numbers);
            });
        } else {
            wrong(name, known.allowed());
        }
    }
}

void Call::check_given() const {
    for (const Option& option : parameters_.options)
        if (option.needed && !option.given)
            throw Error(ErrorKind::usage, entry_->name, "option " + option.name + " is missing", "give " + option.help);
    std::vector<Path> inputs, outputs;
    for (const Slot* slot : parameters_.slots()) {
        if (slot->needed && slot->sources.empty() && slot->role == Role::input && !slot->may_be_new)
            throw Error(ErrorKind::usage, entry_->name, slot->name + " is missing", "give " + slot->help);
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
    in_operation(entry_->name, [&] { operation_->check(); });
    for (const Slot* slot : parameters_.slots())
        for (const Source& source : slot->sources)
            if (slot->role == Role::input && !source.file.empty() && slot->kind != Kind::collection && !is_folder(source.file) &&
                (!slot->may_be_new || file_exists(source.file)))
                check_readable(source.file);
}

Report Call::run(Context& context, const std::function<void(const Report&)>& before_commit) {
    for (Slot* slot : parameters_.slots()) {
        if (slot->updated != nullptr && slot->sources.empty()) {
            const bool given = static_cast<bool>(*slot->updated);
            if (given) slot->sources.push_back({slot->updated->sources.front().file, {}, true});
            else if (slot->updated->needed) slot->sources.emplace_back();
        }
        if (slot->role == Role::output && slot->needed && slot->sources.empty()) slot->sources.emplace_back();
        slot->context = &context;
    }
    in_operation(entry_->name, [&] { parameters_.options.check(""); });
    check_given();
    Report report({entry_->name, {}, {}}, parameters_.report);
    report.on_note = context.on_note;
    Context::Run run{entry_->name, &parameters_, &report, {}, {}, {}, {}};
    struct Under {
        Context& context;
        Context::Run* outer;
        ~Under() { context.run_ = outer; }
    } under{context, context.run_};
    context.run_ = &run;
    const WatchScope watch(&context.watch);
    check_cancelled();
    OutputTransaction outputs;
    operation_->run(context, report);
    report.set_provenance(context.provenance());
    check_cancelled();
    if (before_commit) before_commit(report);
    outputs.commit();
    for (Slot* slot : parameters_.slots()) slot->finish();
    return report;
}

const Object& Call::object(const std::string& name, std::size_t i) const {
    const Slot* found = parameters_.slot(name);
    if (found == nullptr) no_such_name(name);
    if (i >= found->size() || !found->sources[i].object)
        throw Error(ErrorKind::usage, entry_->name, name + " holds no object", "it was not asked for, or written to a file");
    return found->sources[i].object;
}

// ---- schemas ----

namespace {

JsonValue option_schema(const Option& option, JsonAllocator& allocator) {
    JsonValue schema(rapidjson::kObjectType), inner(rapidjson::kObjectType);
    const OptionType type = option.type();
    const bool list = option.is_list();
    const char* name = type == OptionType::boolean                                   ? "boolean"
                       : type == OptionType::integer || type == OptionType::integers ? "integer"
                       : type == OptionType::number || type == OptionType::numbers   ? "number"
                                                                                     : "string";
    add_member(inner, "type", name, allocator);
    if (const auto* range = std::get_if<Range>(&option.rule)) {
        add_member(inner, "minimum", JsonValue(range->min), allocator);
        add_member(inner, "maximum", JsonValue(range->max), allocator);
    }
    if (const auto* choices = std::get_if<Choices>(&option.rule)) {
        JsonValue names(rapidjson::kArrayType);
        for (const auto& choice : choices->names) names.PushBack(json_string(choice, allocator), allocator);
        add_member(inner, "enum", std::move(names), allocator);
    }
    if (list) {
        add_member(schema, "type", "array", allocator);
        add_member(schema, "items", std::move(inner), allocator);
    } else {
        schema = std::move(inner);
    }
    add_member(schema, "description", option.help + (option.unit.empty() ? "" : " (" + option.unit + ")"), allocator);
    return schema;
}

/// The value before anything was set, in its type.
JsonValue initial_of(const Option& option, JsonAllocator& allocator) {
    const OptionType type = option.type();
    if (type == OptionType::boolean) return JsonValue(option.initial == "true");
    if (type == OptionType::integer) return JsonValue(static_cast<std::int64_t>(std::stod(option.initial)));
    if (type == OptionType::number) return JsonValue(std::stod(option.initial));
    return json_string(option.initial, allocator);
}

}  // namespace

JsonValue Call::schema(JsonAllocator& allocator) const {
    JsonValue schema(rapidjson::kObjectType), properties(rapidjson::kObjectType), needed(rapidjson::kArrayType);
    add_member(schema, "$schema", "http://json-schema.org/draft-04/schema#", allocator);
    add_member(schema, "title", entry_->name, allocator);
    add_member(schema, "description", entry_->help, allocator);
    add_member(schema, "type", "object", allocator);
    for (const Slot* slot : parameters_.slots()) {
        JsonValue one(rapidjson::kObjectType);
        if (slot->repeated) {
            JsonValue items(rapidjson::kObjectType);
            add_member(items, "type", "string", allocator);
            add_member(one, "type", "array", allocator);
            add_member(one, "items", std::move(items), allocator);
        } else if (slot->role == Role::input) {
            add_member(one, "type", "string", allocator);
        } else {
            JsonValue types(rapidjson::kArrayType);
            types.PushBack("string", allocator).PushBack("boolean", allocator);
            add_member(one, "type", std::move(types), allocator);
        }
        add_member(one, "description", slot->help, allocator);
        add_member(properties, slot->name, std::move(one), allocator);
        if (slot->needed && slot->role == Role::input && !slot->may_be_new)
            needed.PushBack(json_string(slot->name, allocator), allocator);
    }
    for (const Option& option : parameters_.options) {
        add_member(properties, option.name, option_schema(option, allocator), allocator);
        if (option.needed) needed.PushBack(json_string(option.name, allocator), allocator);
    }
    add_member(schema, "properties", std::move(properties), allocator);
    if (!needed.Empty()) add_member(schema, "required", std::move(needed), allocator);
    add_member(schema, "additionalProperties", JsonValue(false), allocator);
    return schema;
}

JsonValue Call::declaration(JsonAllocator& allocator) const {
    JsonValue object(rapidjson::kObjectType), inputs(rapidjson::kArrayType), outputs(rapidjson::kArrayType),
        options(rapidjson::kArrayType), orders(rapidjson::kArrayType);
    add_member(object, "name", entry_->name, allocator);
    add_member(object, "help", entry_->help, allocator);
    for (const Slot* slot : parameters_.slots()) {
        JsonValue one(rapidjson::kObjectType);
        add_member(one, "name", slot->name, allocator);
        add_member(one, "kind", to_string(slot->kind), allocator);
        add_member(one, "required", JsonValue(slot->needed), allocator);
        add_member(one, "repeated", JsonValue(slot->repeated), allocator);
        if (slot->updated != nullptr) add_member(one, "updates", slot->updated->name, allocator);
        add_member(one, "help", slot->help, allocator);
        (slot->role == Role::input ? inputs : outputs).PushBack(one, allocator);
    }
    for (const Option& option : parameters_.options) {
        static constexpr const char* types[]{"boolean", "integer", "number", "text", "choice", "texts", "numbers", "integers"};
        JsonValue one(rapidjson::kObjectType);
        add_member(one, "name", option.name, allocator);
        add_member(one, "type", types[static_cast<std::size_t>(option.type())], allocator);
        if (const auto* range = std::get_if<Range>(&option.rule)) {
            add_member(one, "minimum", JsonValue(range->min), allocator);
            add_member(one, "maximum", JsonValue(range->max), allocator);
        }
        if (const auto* choices = std::get_if<Choices>(&option.rule)) {
            JsonValue names(rapidjson::kArrayType);
            for (const auto& choice : choices->names) names.PushBack(json_string(choice, allocator), allocator);
            add_member(one, "choices", std::move(names), allocator);
        }
        if (!option.initial.empty()) add_member(one, "default", initial_of(option, allocator), allocator);
        if (!option.unit.empty()) add_member(one, "unit", option.unit, allocator);
        if (!option.group.empty()) add_member(one, "group", option.group, allocator);
        add_member(one, "required", JsonValue(option.needed), allocator);
        add_member(one, "help", option.help, allocator);
        options.PushBack(one, allocator);
    }
    for (const auto& order : parameters_.orders) {
        JsonValue list(rapidjson::kArrayType);
        for (const auto& name : order) list.PushBack(json_string(name, allocator), allocator);
        orders.PushBack(list, allocator);
    }
    add_member(object, "inputs", std::move(inputs), allocator);
    add_member(object, "outputs", std::move(outputs), allocator);
    add_member(object, "options", std::move(options), allocator);
    add_member(object, "arguments", std::move(orders), allocator);
    add_member(object, "result", parameters_.report.to_schema(allocator), allocator);
    return object;
}

}  // namespace ostraka
