#include "ostraka/workflow/record.h"

#include "ostraka/collection/objects.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace ostraka {

namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

JsonValue pairs_to_json(const Pairs& pairs, JsonAllocator& allocator) {
    return json_list(pairs, allocator, [&](const auto& name_and_value) {
        JsonValue pair(rapidjson::kArrayType);
        pair.PushBack(json_string(name_and_value.first, allocator), allocator)
            .PushBack(json_string(name_and_value.second, allocator), allocator);
        return pair;
    });
}
Pairs pairs_of(const JsonValue& pair_list) {
    Pairs pairs;
    for (const auto& name_and_value : pair_list.GetArray())
        pairs.emplace_back(text_of(name_and_value[0]), text_of(name_and_value[1]));
    return pairs;
}

void add_files(const Path& root, const Path& folder, Pairs& files, FileChecksums& checksums) {
    for (const std::string& name : files_in(folder))
        files.emplace_back((folder / name).lexically_relative(root).generic_string(), checksums.file(folder / name));
    if (is_memory(folder)) return;
    std::vector<Path> folders;
    std::error_code code;
    for (std::filesystem::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
        if (std::error_code type_error; entry->is_directory(type_error) && !entry->is_symlink(type_error))
            folders.push_back(entry->path());
    std::sort(folders.begin(), folders.end());
    for (const Path& subfolder : folders) add_files(root, subfolder, files, checksums);
}

std::optional<StudyRecord> parsed_record(const Path& file) {
    try {
        const Json document = read_json(file);
        validate(document, "study-record", file.string());
        StudyRecord record;
        record.depends = pairs_of(*find_member(document, "depends"));
        record.read = pairs_of(*find_member(document, "read"));
        for (const auto& member : find_member(document, "outputs")->GetObject())
            record.outputs[text_of(member.name)] = {text_in(member.value, "file"), text_in(member.value, "sha256"),
                                                    flag_in(member.value, "kept"), flag_in(member.value, "folder")};
        record.holds = flag_in(document, "holds");
        const JsonValue& run = *find_member(document, "run");
        record.seconds = number_or(run, "seconds", 0);
        record.began = text_in(run, "began");
        record.ended = text_in(run, "ended");
        return record;
    } catch (const Error&) {
        return {};  // damaged: treated as missing
    }
}

}  // namespace

std::optional<FileStamp> stamp_of(const Path& file) {
    struct stat status {};
    if (is_memory(file) || ::stat(file.c_str(), &status) != 0) return {};
    return FileStamp{static_cast<std::uintmax_t>(status.st_size), status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

std::string FileChecksums::file(const Path& file) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto entry = entries_.find(file); entry != entries_.end()) return entry->second.sha256;
    }
    check_readable(file);
    const auto stamp = stamp_of(file);  // taken before reading, so that concurrent writes are detected
    std::string checksum = sha256_of_file(file);
    const std::lock_guard lock(mutex_);
    if (!is_memory(file)) entries_[file] = {checksum, stamp};
    return checksum;
}

std::string FileChecksums::folder(const Path& folder) {
    Pairs files;
    add_files(folder, folder, files, *this);
    std::string text;
    for (const auto& [name, checksum] : files) text += checksum + "  " + name + "\n";
    return sha256(text);
}

std::string FileChecksums::collection(const Path& folder_or_file) {
    if (is_folder(folder_or_file)) return folder(folder_or_file);
    if (!file_exists(folder_or_file) || extension(folder_or_file) != ".json") return file(folder_or_file);
    const Json document = read_json(folder_or_file);
    if (find_member(document, "objects") == nullptr) return file(folder_or_file);
    std::string text = file(folder_or_file) + "\n";
    for (const auto& object : read_collection(folder_or_file).objects) text += object.checksum + "  " + object.name + "\n";
    return sha256(text);
}

void FileChecksums::forget(const Path& file) {
    const std::lock_guard lock(mutex_);
    entries_.erase(file);
}

void FileChecksums::store(const Path& file, const std::string& sha256) {
    const auto stamp = stamp_of(file);
    const std::lock_guard lock(mutex_);
    const auto [entry, is_new] = entries_.try_emplace(file, Entry{sha256, stamp});
    if (!is_new && entry->second.sha256 != sha256) entry->second.differs = true;
}

std::vector<Path> FileChecksums::changed() {
    const std::lock_guard lock(mutex_);
    std::vector<Path> files;
    for (const auto& [file, entry] : entries_) {
        if (is_memory(file)) continue;
        // A file that was touched or rewritten with the same content has not changed.
        const bool is_same = stamp_of(file) == entry.stamp || (file_exists(file) && sha256_of_file(file) == entry.sha256);
        if (entry.differs || !is_same) files.push_back(file);
    }
    return files;
}

bool FileChecksums::is_known(const Path& file) {
    const std::lock_guard lock(mutex_);
    return entries_.contains(file);
}

std::optional<StudyRecord> read_record(const Path& folder) {
    const Path file = folder / "record.json";
    if (!file_exists(file)) return {};
    std::optional<StudyRecord> record = parsed_record(file);
    if (record)
        for (const auto& [name, output] : record->outputs)
            static_cast<void>(file_inside(output.file, folder, file.string(),
                                          fmt::format("/outputs/{}/file", printable(name, 60)), "the folder of the step",
                                          "remove " + folder.string()));
    return record;
}

void write_record(const Path& folder, const StudyPlan& plan, const StudyInstance& instance, const StudyRecord& record) {
    Json document = json_document("study-record");
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "step", plan.study.steps[instance.step].name);
    JsonValue parameters(rapidjson::kObjectType);
    for (std::size_t p = 0; p < instance.values.size(); ++p)
        if (instance.values[p] != no_instance)
            add_members(parameters, allocator, plan.study.parameters[p].name,
                        plan.study.parameters[p].values[instance.values[p]].label);
    add_members(document, allocator, "parameters", std::move(parameters), "depends", pairs_to_json(record.depends, allocator),
                "read", pairs_to_json(record.read, allocator));
    JsonValue outputs(rapidjson::kObjectType);
    for (const auto& [name, output] : record.outputs) {
        JsonValue output_object = json_object(allocator, "file", output.file, "sha256", output.sha256);
        add_nonempty_members(output_object, allocator, "kept", output.kept, "folder", output.is_folder);
        add_members(outputs, allocator, name, std::move(output_object));
    }
    add_members(document, allocator, "outputs", std::move(outputs), "holds", record.holds, "run",
                json_object(allocator, "seconds", record.seconds, "began", record.began, "ended", record.ended));
    write_json(folder / "record.json", document);
}

Path find_program(const std::string& name, const Path& program_folder, const std::string& where) {
    const Path program = program_folder / name;
    if (name.find('/') != std::string::npos || !file_exists(program) || ::access(program.c_str(), X_OK) != 0)
        fail_input(
            where, fmt::format("there is no program '{}' in {}", printable(name, 60), program_folder.string()),
            "programs are expected in the folder of the command; build or install it there, or name their folder (--programs)");
    return program;
}

Pairs dependencies(const StudyPlan& plan, const StudyInstance& instance,
                   const std::function<const StudyRecord&(std::size_t)>& record_of, FileChecksums& checksums,
                   const Path& program_folder) {
    const StudyStep& step = plan.study.steps[instance.step];
    Pairs depends{{"toolkit", version()}};
    std::map<std::string, Kind> kinds;
    if (step.operation != nullptr) {
        depends.emplace_back("operation", fmt::format("{}, version {}", step.operation->name, step.operation->version));
        Call call(*step.operation);
        call.set(*instance.options);
        for (const auto& [name, value] : call.parameters().options.values())
            if (!value.empty()) depends.emplace_back("option " + name, value);
        for (const Slot* slot : call.parameters().slots()) kinds[slot->name] = slot->kind;
        for (const auto& [output, file] : instance.outputs) depends.emplace_back("output " + output, file);
    } else {
        const std::string where = plan.study.at(step.place + "/program/0");
        depends.emplace_back("program", instance.program.front());
        depends.emplace_back("program file", checksums.file(find_program(instance.program.front(), program_folder, where)));
        for (std::size_t i = 1; i < instance.program.size(); ++i)
            depends.emplace_back("word " + std::to_string(i), instance.program[i].empty() ? "(an output)" : instance.program[i]);
    }
    std::map<std::string, std::size_t> counts;
    for (const StudyInput& input : instance.inputs) {
        const std::string name = fmt::format("input {} {}", input.slot, ++counts[input.slot]);
        std::string called = input.label.empty() ? "" : input.label + "=";
        if (input.instance != no_instance) {
            const StudyRecord& record = record_of(input.instance);
            const auto output = record.outputs.find(input.output);
            if (output == record.outputs.end())
                fail_work(plan.instances[input.instance].title(plan.study), fmt::format("did not produce '{}'", input.output),
                          "name one of the files that it wrote");
            depends.emplace_back(name, fmt::format("{} {}{}", output->second.sha256, called, output->second.file));
        } else if (input.file.empty()) {
            depends.emplace_back(name, "none");
        } else {
            const auto kind = kinds.find(input.slot);
            const bool collection = (kind != kinds.end() && kind->second == Kind::collection) || is_folder(input.file);
            depends.emplace_back(
                name, fmt::format("{} {}{}", collection ? checksums.collection(input.file) : checksums.file(input.file), called,
                                  input.file.filename().string()));
        }
    }
    return depends;
}

std::string rerun_reason(const StudyPlan& plan, const std::optional<StudyRecord>& record, const Pairs& depends,
                         const StudyInstance& instance, const Path& run_folder, FileChecksums& checksums) {
    const Path folder = run_folder / instance.folder;
    if (!record) return "it has not run yet";
    std::vector<std::string> reasons;
    const std::map<std::string, std::string> recorded(record->depends.begin(), record->depends.end()),
        now(depends.begin(), depends.end());
    const auto abbreviated = [](const std::string& name, const std::string& value) {
        return name.starts_with("input") || name == "program file"
                   ? value.substr(0, 12) + value.substr(std::min<std::size_t>(value.size(), 64))
                   : value;
    };
    for (const auto& [name, value] : depends)
        if (const auto was = recorded.find(name); was == recorded.end())
            reasons.push_back(fmt::format("{} is new: {}", name, abbreviated(name, value)));
        else if (was->second != value)
            reasons.push_back(fmt::format("{} was {}, is {}", name, abbreviated(name, was->second), abbreviated(name, value)));
    for (const auto& [name, value] : record->depends)
        if (!now.contains(name)) reasons.push_back(fmt::format("{} is no longer used, was {}", name, abbreviated(name, value)));
    for (const auto& [file, checksum] : record->read) {
        const bool is_own = file.starts_with(run_folder_prefix);
        const Path path = is_own ? run_folder / file.substr(run_folder_prefix.size()) : plan.study.folder / file;
        if (is_own ? !is_inside(path, run_folder) : !is_inside_any(path, plan.study.readable))
            reasons.push_back(fmt::format("'{}', which an input refers to, lies outside the readable folders", file));
        else if (!file_exists(path)) reasons.push_back(fmt::format("'{}', which an input refers to, no longer exists", file));
        else if (checksums.file(path) != checksum)
            reasons.push_back(fmt::format("'{}', which an input refers to, has changed", file));
    }
    for (const auto& [output, file] : instance.outputs) {
        const auto was = record->outputs.find(output);
        if (was == record->outputs.end()) reasons.push_back(fmt::format("output {} was not produced", output));
        else if (instance.kept.contains(output) && !was->second.kept)
            reasons.push_back(fmt::format("output {} was not kept", output));
    }
    for (const auto& [output, was] : record->outputs) {
        if (!was.kept) continue;
        const Path file = folder / was.file;
        const bool exists = was.is_folder ? is_folder(file) : file_exists(file);
        if (!exists) reasons.push_back(fmt::format("'{}' no longer exists", file.string()));
        else if ((was.is_folder ? checksums.folder(file) : checksums.file(file)) != was.sha256)
            reasons.push_back(fmt::format("'{}' was changed", file.string()));
    }
    if (!file_exists(folder / "report.json")) reasons.push_back("its report no longer exists");
    return joined(reasons, "; ");
}

}  // namespace ostraka
