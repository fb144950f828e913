#include "call_state.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>
#include <stdexcept>

namespace ostraka {

struct Object::Made {
    std::mutex mutex;
    std::map<std::string, Checksums> of;  ///< by name of the object
};

std::shared_ptr<Object::Made> Object::make_made() { return std::make_shared<Made>(); }

const Object::Checksums& Object::checksums() const {
    const std::lock_guard lock(made_->mutex);
    if (const auto known = made_->of.find(name); known != made_->of.end()) return known->second;
    Checksums sums{sha256, {}};  // stored only once complete, because writing may be cancelled
    if (sums.sha256.empty() && write) {
        static std::atomic<std::size_t> count{0};
        struct Folder {
            const Path path = "memory:.checksum/" + std::to_string(++count);
            ~Folder() { forget_memory(path); }
        } const folder;
        const Path file = folder.path / Path(name).filename();
        OutputTransaction own;
        write(file);
        own.commit();
        sums.sha256 = sha256_of_file(file);
        for (const std::string& one : files_in(folder.path))  // e.g. the header of coordinates
            if (one != file.filename()) sums.beside.emplace_back(one, sha256_of_file(folder.path / one));
    } else if (const auto bytes = as<std::string>(); sums.sha256.empty() && bytes) {
        sums.sha256 = ostraka::sha256(*bytes);
    } else if (const auto document = as<Json>(); sums.sha256.empty() && document) {
        sums.sha256 = ostraka::sha256(to_text(*document));
    }
    return made_->of.emplace(name, std::move(sums)).first->second;
}

const std::string& Context::CallState::know(const Slot& slot, std::size_t i) {
    std::string& sum = checksums[{&slot, i}];
    if (!sum.empty()) return sum;
    const Object::Checksums& made = slot.sources[i].object.checksums();
    named.insert(named.end(), made.beside.begin(), made.beside.end());
    return sum = made.sha256;
}

void Context::CallState::add(const std::vector<ReadRecord::Entry>& files) {
    for (const auto& entry : files)
        if (std::none_of(read.begin(), read.end(), [&](const auto& known) { return known.file == entry.file; }))
            read.push_back(entry);
}

std::vector<Path> Context::CallState::inputs() const {
    std::vector<Path> files;
    for (const auto& entry : read) files.push_back(entry.file);
    for (const Slot* slot : parameters->slots())
        if (parameters->updated_in_place(*slot)) std::erase(files, slot->sources.front().file);
    return files;
}

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
        if (const auto known = objects.find(name); known != objects.end()) {
            const auto& files = known->second.files;
            if (std::all_of(files.begin(), files.end(), [](const File& file) { return file.unchanged(); })) return known->second;
            objects.erase(known);
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

Context::Context() : kept_(std::make_shared<Kept>()) {}

void Context::share_objects(Context& other) {
    keep_objects = other.keep_objects = true;
    kept_ = other.kept_;
}

void Context::forget(const Path& file) {
    const std::lock_guard lock(kept_->mutex);
    std::erase_if(kept_->objects, [&](const auto& one) { return std::get<0>(one.first) == file.string(); });
}

Context::~Context() {
    for (const Path& file : memory_) forget_memory(file);
}

Provenance Context::provenance() const {
    if (run_ == nullptr) throw std::logic_error("no operation is under way");
    Provenance provenance;
    provenance.command = run_->command;
    provenance.options = run_->parameters->options.values();
    std::erase_if(provenance.options, [](const auto& option) { return option.second.empty(); });
    std::set<Path> listed;
    std::map<Path, std::string> known;  // checksums of files already read
    for (const auto& entry : run_->read) known.emplace(entry.file, entry.sha256);
    for (const Slot* slot : run_->parameters->slots()) {
        if (slot->role != Role::input) continue;
        for (std::size_t i = 0; i < slot->sources.size(); ++i) {
            const Source& source = slot->sources[i];
            if (source.object.as<Path>()) continue;  // a folder; its files are recorded separately
            if (source.object) {
                provenance.inputs.emplace_back(Path(source.object.name).filename().string(), run_->know(*slot, i));
                continue;
            }
            listed.insert(source.file);
            const std::string called = (source.label.empty() ? "" : source.label + "=") + source.file.filename().string();
            if (!known.contains(source.file)) {  // not read yet, or a folder, whose files are recorded separately
                if (!file_exists(source.file)) continue;
                run_->read.push_back({source.file, sha256_of_file(source.file)});
                known.emplace(source.file, run_->read.back().sha256);
            }
            provenance.inputs.emplace_back(called, known.at(source.file));
        }
    }
    for (const auto& entry : run_->read)
        if (!is_memory(entry.file) && !listed.contains(entry.file))
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
        if (const auto known = kept_->find_or_begin(name)) {
            for (const auto& file : known->files) {
                run_->add({file.entry});
                if (run_->within != nullptr) run_->within->push_back(file.entry);
            }
            return run_->loaded[place] = known->data;
        }
    std::optional<Kept::Entry> entry;
    struct End {  // ends the reading also if an exception is thrown
        Kept* kept;
        const Kept::Name& name;
        std::optional<Kept::Entry>& entry;
        ~End() {
            if (kept != nullptr) kept->end(name, std::move(entry));
        }
    } const end{shared ? kept_.get() : nullptr, name, entry};
    std::vector<ReadRecord::Entry> files;
    std::shared_ptr<const void> data;
    {
        const ReadRecord record;
        struct Within {
            CallState& run;
            std::vector<ReadRecord::Entry>* outer;
            ~Within() { run.within = outer; }
        } const within{*run_, std::exchange(run_->within, &files)};
        data = read(source.file);
        files.insert(files.end(), record.files.begin(), record.files.end());
    }
    run_->add(files);
    if (run_->within != nullptr) run_->within->insert(run_->within->end(), files.begin(), files.end());
    if (shared) {
        entry.emplace(Kept::Entry{{}, data});
        for (const auto& file : files) {
            std::error_code code;
            if (is_memory(file.file)) entry->files.push_back({file, 0, {}});
            else
                entry->files.push_back(
                    {file, std::filesystem::file_size(file.file, code), std::filesystem::last_write_time(file.file, code)});
        }
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

std::string Context::checksum_of_object(const Slot& slot, std::size_t i) { return run_->know(slot, i); }

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

void Context::check_output(const Path& file) const { ostraka::check_outputs(run_->inputs(), {file}); }

void Context::check_outputs(const std::vector<Path>& further) const {
    std::vector<Path> inputs = run_->inputs(), outputs;
    for (const Slot* slot : run_->parameters->slots())
        if (dynamic_cast<const FolderOutput*>(slot) == nullptr && !run_->parameters->updated_in_place(*slot))
            for (const Source& source : slot->sources) (slot->role == Role::input ? inputs : outputs).push_back(source.file);
    outputs.insert(outputs.end(), further.begin(), further.end());
    ostraka::check_outputs(inputs, outputs);
}

}  // namespace ostraka
