#include "framework/call_state.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>
#include <stdexcept>

namespace ostraka {

struct Object::ChecksumCache {
    std::mutex mutex;
    std::map<std::string, Checksums> by_name;  ///< by name of the object
};

std::shared_ptr<Object::ChecksumCache> Object::make_checksum_cache() { return std::make_shared<ChecksumCache>(); }

const Object::Checksums& Object::checksums() const {
    const std::lock_guard lock(checksum_cache_->mutex);
    if (const auto cached = checksum_cache_->by_name.find(name); cached != checksum_cache_->by_name.end()) return cached->second;
    Checksums sums{sha256, {}};  // stored only once complete, because writing may be cancelled
    if (sums.sha256.empty() && write) {
        static std::atomic<std::size_t> count{0};
        struct Folder {
            const Path path = "memory:.checksum/" + std::to_string(++count);
            ~Folder() { remove_memory_files(path); }
        } const folder;
        const Path file = folder.path / Path(name).filename();
        OutputTransaction transaction;
        write(file);
        transaction.commit();
        sums.sha256 = sha256_of_file(file);
        for (const std::string& file_name : files_in(folder.path))  // e.g. the header of coordinates
            if (file_name != file.filename()) sums.beside.emplace_back(file_name, sha256_of_file(folder.path / file_name));
    } else if (const auto bytes = as<std::string>(); sums.sha256.empty() && bytes) {
        sums.sha256 = ostraka::sha256(*bytes);
    } else if (const auto document = as<Json>(); sums.sha256.empty() && document) {
        sums.sha256 = ostraka::sha256(to_text(*document));
    }
    return checksum_cache_->by_name.emplace(name, std::move(sums)).first->second;
}

const std::string& Context::CallState::checksum_of(const Slot& slot, std::size_t i) {
    std::string& checksum = checksums[{&slot, i}];
    if (!checksum.empty()) return checksum;
    const Object::Checksums& object_checksums = slot.sources[i].object.checksums();
    recorded_inputs.insert(recorded_inputs.end(), object_checksums.beside.begin(), object_checksums.beside.end());
    return checksum = object_checksums.sha256;
}

void Context::CallState::add(const std::vector<ReadRecord::Entry>& files) {
    for (const auto& entry : files)
        if (std::none_of(read.begin(), read.end(), [&](const auto& other) { return other.file == entry.file; }))
            read.push_back(entry);
}

std::vector<Path> Context::CallState::inputs() const {
    std::vector<Path> files;
    for (const auto& entry : read) files.push_back(entry.file);
    for (const Slot* slot : parameters->slots())
        if (parameters->updated_in_place(*slot)) std::erase(files, slot->sources.front().file);
    return files;
}

struct Context::ObjectCache {
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
    using Name = std::tuple<std::string, std::type_index, std::string>;
    std::map<Name, Entry> objects;
    std::set<Name> reading;  ///< names that a sharing context is reading
    std::mutex mutex;
    std::condition_variable read;

    /// The cached entry of this name if it is unchanged, after waiting for any reader of it; otherwise the caller becomes its
    /// reader.
    std::optional<Entry> find_or_begin(const Name& name) {
        std::unique_lock lock(mutex);
        read.wait(lock, [&] { return !reading.contains(name); });
        if (const auto cached = objects.find(name); cached != objects.end()) {
            const auto& files = cached->second.files;
            if (std::all_of(files.begin(), files.end(), [](const File& file) { return file.unchanged(); })) return cached->second;
            objects.erase(cached);
        }
        reading.insert(name);
        return {};
    }
    void end(const Name& name, std::optional<Entry> entry) {
        const std::lock_guard lock(mutex);
        reading.erase(name);
        if (entry) objects.insert_or_assign(name, std::move(*entry));
        read.notify_all();
    }
};

Context::Context() : object_cache_(std::make_shared<ObjectCache>()) {}

void Context::share_objects(Context& other) {
    keep_objects = other.keep_objects = true;
    object_cache_ = other.object_cache_;
}

void Context::forget(const Path& file) {
    const std::lock_guard lock(object_cache_->mutex);
    std::erase_if(object_cache_->objects, [&](const auto& cached) { return std::get<0>(cached.first) == file.string(); });
}

Context::~Context() {
    for (const Path& file : memory_) remove_memory_files(file);
}

Provenance Context::provenance() const {
    if (call_ == nullptr) throw std::logic_error("no operation is running");
    Provenance provenance;
    provenance.command = call_->command;
    provenance.options = call_->parameters->options.values();
    std::erase_if(provenance.options, [](const auto& option) { return option.second.empty(); });
    std::set<Path> listed;
    std::map<Path, std::string> checksums_by_file;  // checksums of files already read
    for (const auto& entry : call_->read) checksums_by_file.emplace(entry.file, entry.sha256);
    for (const Slot* slot : call_->parameters->slots()) {
        if (slot->role != Role::input) continue;
        for (std::size_t i = 0; i < slot->sources.size(); ++i) {
            const Source& source = slot->sources[i];
            if (source.object.as<Path>()) continue;  // a folder; its files are recorded separately
            if (source.object) {
                provenance.inputs.emplace_back(Path(source.object.name).filename().string(), call_->checksum_of(*slot, i));
                continue;
            }
            listed.insert(source.file);
            const std::string input_name = (source.label.empty() ? "" : source.label + "=") + source.file.filename().string();
            if (!checksums_by_file.contains(source.file)) {  // not read yet, or a folder, whose files are recorded separately
                if (!file_exists(source.file)) continue;
                call_->read.push_back({source.file, sha256_of_file(source.file)});
                checksums_by_file.emplace(source.file, call_->read.back().sha256);
            }
            provenance.inputs.emplace_back(input_name, checksums_by_file.at(source.file));
        }
    }
    for (const auto& entry : call_->read)
        if (!is_memory(entry.file) && !listed.contains(entry.file))
            provenance.inputs.emplace_back(entry.file.filename().string(), entry.sha256);
    provenance.inputs.insert(provenance.inputs.end(), call_->recorded_inputs.begin(), call_->recorded_inputs.end());
    return provenance;
}

std::shared_ptr<const void> Context::load(const Slot& slot, std::size_t i, std::type_index type, const std::string& key,
                                          const Read& read) {
    if (call_ == nullptr) throw std::logic_error("no operation is running");
    if (i >= slot.sources.size()) throw std::logic_error("nothing was given for " + slot.name);
    const auto load_key = std::tuple(&slot, i, type, key);
    if (const auto loaded = call_->loaded.find(load_key); loaded != call_->loaded.end()) return loaded->second;
    check_cancelled();
    const Source& source = slot.sources[i];
    if (source.object) call_->checksum_of(slot, i);
    const bool shared = keep_objects && !source.object;
    const auto name = std::tuple(source.file.string(), type, key);
    if (shared)
        if (const auto cached = object_cache_->find_or_begin(name)) {
            for (const auto& file : cached->files) {
                call_->add({file.entry});
                if (call_->within != nullptr) call_->within->push_back(file.entry);
            }
            return call_->loaded[load_key] = cached->data;
        }
    std::optional<ObjectCache::Entry> entry;
    struct End {  // ends the reading also if an exception is thrown
        ObjectCache* kept;
        const ObjectCache::Name& name;
        std::optional<ObjectCache::Entry>& entry;
        ~End() {
            if (kept != nullptr) kept->end(name, std::move(entry));
        }
    } const end{shared ? object_cache_.get() : nullptr, name, entry};
    std::vector<ReadRecord::Entry> files;
    std::shared_ptr<const void> data;
    {
        const ReadRecord record;
        struct Within {
            CallState& run;
            std::vector<ReadRecord::Entry>* outer;
            ~Within() { run.within = outer; }
        } const within{*call_, std::exchange(call_->within, &files)};
        data = read(source.file);
        files.insert(files.end(), record.files.begin(), record.files.end());
    }
    call_->add(files);
    if (call_->within != nullptr) call_->within->insert(call_->within->end(), files.begin(), files.end());
    if (shared) {
        entry.emplace(ObjectCache::Entry{{}, data});
        for (const auto& file : files) {
            std::error_code code;
            if (is_memory(file.file)) entry->files.push_back({file, 0, {}});
            else
                entry->files.push_back(
                    {file, std::filesystem::file_size(file.file, code), std::filesystem::last_write_time(file.file, code)});
        }
    }
    return call_->loaded[load_key] = data;
}

void Context::record(const std::function<void()>& read) {
    const ReadRecord record;
    read();
    call_->add(record.files);
}

std::vector<Path> Context::files_so_far() const {
    std::vector<Path> files;
    for (const ReadRecord::Entry& entry : call_->read) files.push_back(entry.file);
    return files;
}

void Context::record_input(const std::string& name, const std::string& sha256) {
    call_->recorded_inputs.emplace_back(name, sha256);
}

void Context::record_object(const Slot& slot, std::size_t i, const std::string& sha256) { call_->checksums[{&slot, i}] = sha256; }

std::string Context::checksum_of_object(const Slot& slot, std::size_t i) { return call_->checksum_of(slot, i); }

void Context::note(const std::string& text) { call_->report->note(text); }

void Context::notes(const std::string& file, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
        if (std::find(call_->reported_notes.begin(), call_->reported_notes.end(), std::pair(file, text)) !=
            call_->reported_notes.end())
            continue;
        call_->reported_notes.emplace_back(file, text);
        call_->report->note(file.empty() ? text : fmt::format("{}: {}", file, text));
    }
}

Path Context::memory(const std::string& name) {
    static std::atomic<std::size_t> count{0};
    const Path folder = "memory:" + std::to_string(++count);
    memory_.push_back(folder);
    return folder / name;
}

void Context::check_output(const Path& file) const { ostraka::check_outputs(call_->inputs(), {file}); }

void Context::check_outputs(const std::vector<Path>& further) const {
    std::vector<Path> inputs = call_->inputs(), outputs;
    for (const Slot* slot : call_->parameters->slots())
        if (dynamic_cast<const FolderOutput*>(slot) == nullptr && !call_->parameters->updated_in_place(*slot))
            for (const Source& source : slot->sources) (slot->role == Role::input ? inputs : outputs).push_back(source.file);
    outputs.insert(outputs.end(), further.begin(), further.end());
    ostraka::check_outputs(inputs, outputs);
}

}  // namespace ostraka
