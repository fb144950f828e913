#include "ostraka/workflow/record.h"

#include "ostraka/collection/objects.h"
#include "ostraka/core/json_build.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/words.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace ostraka {

namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

JsonValue pairs_to_json(const Pairs& pairs, JsonAllocator& allocator) {
    return json_list(pairs, allocator, [&](const auto& one) {
        JsonValue pair(rapidjson::kArrayType);
        pair.PushBack(json_string(one.first, allocator), allocator).PushBack(json_string(one.second, allocator), allocator);
        return pair;
    });
}
Pairs pairs_of(const JsonValue& list) {
    Pairs pairs;
    for (const auto& one : list.GetArray()) pairs.emplace_back(text_of(one[0]), text_of(one[1]));
    return pairs;
}

void add_files(const Path& root, const Path& folder, Pairs& files, FileChecksums& checksums) {
    for (const std::string& name : files_in(folder))
        files.emplace_back((folder / name).lexically_relative(root).generic_string(), checksums.file(folder / name));
    if (is_memory(folder)) return;
    std::vector<Path> folders;
    std::error_code code;
    for (std::filesystem::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
        if (std::error_code own; entry->is_directory(own) && !entry->is_symlink(own)) folders.push_back(entry->path());
    std::sort(folders.begin(), folders.end());
    for (const Path& one : folders) add_files(root, one, files, checksums);
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
        if (const auto known = known_.find(file); known != known_.end()) return known->second.sha256;
    }
    check_readable(file);
    const auto stamp = stamp_of(file);  // taken before reading, so that concurrent writes are detected
    std::string sum = sha256_of_file(file);
    const std::lock_guard lock(mutex_);
    if (!is_memory(file)) known_[file] = {sum, stamp};
    return sum;
}

std::string FileChecksums::folder(const Path& folder) {
    Pairs files;
    add_files(folder, folder, files, *this);
    std::string text;
    for (const auto& [name, sum] : files) text += sum + "  " + name + "\n";
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
    known_.erase(file);
}

void FileChecksums::know(const Path& file, const std::string& sha256) {
    const auto stamp = stamp_of(file);
    const std::lock_guard lock(mutex_);
    const auto [known, is_new] = known_.try_emplace(file, Known{sha256, stamp});
    if (!is_new && known->second.sha256 != sha256) known->second.differs = true;
}

std::vector<Path> FileChecksums::changed() {
    const std::lock_guard lock(mutex_);
    std::vector<Path> files;
    for (const auto& [file, known] : known_) {
        if (is_memory(file)) continue;
        // A file that was touched or rewritten with the same content has not changed.
        const bool is_same = stamp_of(file) == known.stamp || (file_exists(file) && sha256_of_file(file) == known.sha256);
        if (known.differs || !is_same) files.push_back(file);
    }
    return files;
}

bool FileChecksums::is_known(const Path& file) {
    const std::lock_guard lock(mutex_);
    return known_.contains(file);
}

std::optional<StudyRecord> read_record(const Path& folder) {
    const Path file = folder / "record.json";
    if (!file_exists(file)) return {};
    std::optional<StudyRecord> record = parsed_record(file);
    if (record)
        for (const auto& [name, output] : record->outputs)
            static_cast<void>(file_inside(output.file, folder, file.string(), "/outputs/" + printable(name, 60) + "/file",
                                          "the folder of the step", "remove " + folder.string()));
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
        JsonValue one = json_object(allocator, "file", output.file, "sha256", output.sha256);
        add_given(one, allocator, "kept", output.kept, "folder", output.is_folder);
        add_members(outputs, allocator, name, std::move(one));
    }
    add_members(document, allocator, "outputs", std::move(outputs), "holds", record.holds, "run",
                json_object(allocator, "seconds", record.seconds, "began", record.began, "ended", record.ended));
    write_json(folder / "record.json", document);
}

Path find_program(const std::string& name, const Path& program_folder, const std::string& where) {
    const Path program = program_folder / name;
    if (name.find('/') != std::string::npos || !file_exists(program) || ::access(program.c_str(), X_OK) != 0)
        fail_input(where, "there is no program '" + printable(name, 60) + "' in " + program_folder.string(),
                   "programs stand beside the command itself; build or install it there, or name their folder (--programs)");
    return program;
}

Pairs dependencies(const StudyPlan& plan, const StudyInstance& instance,
                   const std::function<const StudyRecord&(std::size_t)>& record_of, FileChecksums& checksums,
                   const Path& program_folder) {
    const StudyStep& step = plan.study.steps[instance.step];
    Pairs depends{{"toolkit", version()}};
    std::map<std::string, Kind> kinds;
    if (step.operation != nullptr) {
        depends.emplace_back("operation",
                             std::string(step.operation->name) + ", version " + std::to_string(step.operation->version));
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
        const std::string name = "input " + input.slot + " " + std::to_string(++counts[input.slot]);
        std::string called = input.label.empty() ? "" : input.label + "=";
        if (input.instance != no_instance) {
            const StudyRecord& record = record_of(input.instance);
            const auto output = record.outputs.find(input.output);
            if (output == record.outputs.end())
                fail_work(plan.instances[input.instance].title(plan.study), "has not made '" + input.output + "'",
                          "look at what it wrote, and name that");
            depends.emplace_back(name, output->second.sha256 + " " + called + output->second.file);
        } else if (input.file.empty()) {
            depends.emplace_back(name, "none");
        } else {
            const auto kind = kinds.find(input.slot);
            const bool collection = (kind != kinds.end() && kind->second == Kind::collection) || is_folder(input.file);
            depends.emplace_back(name, (collection ? checksums.collection(input.file) : checksums.file(input.file)) + " " +
                                           called + input.file.filename().string());
        }
    }
    return depends;
}

std::string why_again(const StudyPlan& plan, const std::optional<StudyRecord>& known, const Pairs& depends,
                      const StudyInstance& instance, const Path& run_folder, FileChecksums& checksums) {
    const Path folder = run_folder / instance.folder;
    if (!known) return "it has not run yet";
    std::vector<std::string> reasons;
    const std::map<std::string, std::string> before(known->depends.begin(), known->depends.end()),
        now(depends.begin(), depends.end());
    const auto shown = [](const std::string& name, const std::string& value) {
        return name.starts_with("input") || name == "program file"
                   ? value.substr(0, 12) + value.substr(std::min<std::size_t>(value.size(), 64))
                   : value;
    };
    for (const auto& [name, value] : depends)
        if (const auto was = before.find(name); was == before.end()) reasons.push_back(name + " is new: " + shown(name, value));
        else if (was->second != value)
            reasons.push_back(name + " was " + shown(name, was->second) + ", is " + shown(name, value));
    for (const auto& [name, value] : known->depends)
        if (!now.contains(name)) reasons.push_back(name + " is gone, was " + shown(name, value));
    for (const auto& [file, sum] : known->read) {
        const bool is_own = file.starts_with(in_run);
        const Path path = is_own ? run_folder / file.substr(in_run.size()) : plan.study.folder / file;
        if (is_own ? !is_inside(path, run_folder) : !is_inside_any(path, plan.study.readable))
            reasons.push_back("'" + file + "', which an input names, lies where it may not be read");
        else if (!file_exists(path)) reasons.push_back("'" + file + "', which an input names, is gone");
        else if (checksums.file(path) != sum) reasons.push_back("'" + file + "', which an input names, has changed");
    }
    for (const auto& [output, file] : instance.outputs) {
        const auto was = known->outputs.find(output);
        if (was == known->outputs.end()) reasons.push_back("output " + output + " was not made");
        else if (instance.kept.contains(output) && !was->second.kept) reasons.push_back("output " + output + " was not kept");
    }
    for (const auto& [output, was] : known->outputs) {
        if (!was.kept) continue;
        const Path file = folder / was.file;
        const bool there = was.is_folder ? is_folder(file) : file_exists(file);
        if (!there) reasons.push_back("'" + file.string() + "' is gone");
        else if ((was.is_folder ? checksums.folder(file) : checksums.file(file)) != was.sha256)
            reasons.push_back("'" + file.string() + "' was changed");
    }
    if (!file_exists(folder / "report.json")) reasons.push_back("its report is gone");
    return joined(reasons, "; ");
}

}  // namespace ostraka
