#include "ostraka/files/file.h"

#include "files/output_sweep.h"
#include "files/temporary_file.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/files/transaction.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <shared_mutex>
#include <utility>

namespace ostraka {

namespace {
std::string reason() { return std::strerror(errno); }

struct Descriptor {
    int number;
    ~Descriptor() { ::close(number); }
};

/// An input opened for reading. Only regular files are accepted: devices may never end, and pipes cannot be read again. Opening
/// a pipe does not block.
struct Input {
    explicit Input(const Path& file) : descriptor{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)} {
        if (descriptor.number < 0) fail_input(file.string(), "cannot be opened: " + reason(), "check the path and its rights");
        if (::fstat(descriptor.number, &status) != 0) fail_input(file.string(), "cannot be examined: " + reason());
        if (S_ISREG(status.st_mode)) return;
        if (S_ISDIR(status.st_mode)) fail_input(file.string(), "is a folder", "give a file");
        if (S_ISFIFO(status.st_mode)) fail_input(file.string(), "is a pipe", "write it to a file first");
        fail_input(file.string(), "is a device", "give a file");
    }
    /// Reads up to `size` bytes; returns 0 at the end of the file.
    std::size_t read(char* buffer, std::size_t size, const Path& file) const {
        for (;;) {
            const ssize_t count = ::read(descriptor.number, buffer, size);
            if (count >= 0) return static_cast<std::size_t>(count);
            if (errno != EINTR) fail_input(file.string(), "cannot be read: " + reason());
        }
    }

    Descriptor descriptor;
    struct stat status {};
};

thread_local OutputTransaction* open_transaction = nullptr;
thread_local std::vector<Path> protected_inputs;

/// Several threads may write into one transaction.
std::mutex pending_mutex;
void add_pending(std::vector<std::pair<Path, Path>>& pending, const Path& temporary, const Path& file) {
    const std::lock_guard lock(pending_mutex);
    pending.emplace_back(temporary, file);
}

thread_local ReadRecord* open_record = nullptr;

/// Locked (shared) while files are renamed, and exclusively, for good, when all outputs are abandoned.
std::shared_mutex naming_mutex;

/// Folders to remove when the process exits at once: those created by open transactions, and scratch folders.
class TemporaryFolders {
public:
    void add_created(const Path& folder) {
        change([&] { created_.insert(folder); });
    }
    void forget_created(const std::vector<Path>& folders) {
        change([&] {
            for (const Path& folder : folders) created_.erase(folder);
        });
    }
    void add_scratch(const Path& folder) {
        change([&] { scratch_.insert(folder); });
    }
    void forget_scratch(const Path& folder) {
        change([&] { scratch_.erase(folder); });
    }
    void remove() {
        change([&] {
            std::error_code code;
            for (const Path& folder : scratch_) std::filesystem::remove_all(folder, code);
            for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) std::filesystem::remove(*folder, code);
        });
    }

private:
    template <class Change>
    void change(const Change& work) {
        const std::lock_guard lock(mutex_);
        work();
    }
    std::mutex mutex_;
    std::set<Path> created_, scratch_;  ///< parents before their subfolders
};
TemporaryFolders& temporary_folders() {
    static TemporaryFolders folders;
    return folders;
}

/// The process's umask. Read from /proc: umask() can only read the mask by setting it, and another thread could then create
/// files with wrong permissions.
mode_t creation_mask() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("Umask:")) return static_cast<mode_t>(std::strtoul(line.c_str() + 6, nullptr, 8));
    return 077;
}

/// Files in memory, by their normalised names.
class MemoryFiles {
public:
    [[nodiscard]] std::optional<std::string> find(const Path& file) const {
        const std::lock_guard lock(mutex_);
        const auto entry = files_.find(key(file));
        return entry == files_.end() ? std::nullopt : std::optional(entry->second);
    }
    void put(const Path& file, std::string bytes) {
        const std::lock_guard lock(mutex_);
        files_[key(file)] = std::move(bytes);
    }
    void rename(const Path& from, const Path& to) {
        const std::lock_guard lock(mutex_);
        auto node = files_.extract(key(from));
        if (node.empty()) return;
        files_.erase(key(to));
        node.key() = key(to);
        files_.insert(std::move(node));
    }
    void remove(const Path& file) {
        const std::lock_guard lock(mutex_);
        files_.erase(key(file));
    }
    /// Names below a folder, relative to it.
    [[nodiscard]] std::vector<std::string> below(const Path& folder) const {
        const std::lock_guard lock(mutex_);
        const std::string prefix = key(folder) + "/";
        std::vector<std::string> names;
        for (auto entry = files_.lower_bound(prefix); entry != files_.end() && entry->first.starts_with(prefix); ++entry)
            names.push_back(entry->first.substr(prefix.size()));
        return names;
    }
    Path temporary() {
        const std::lock_guard lock(mutex_);
        return "memory:.temporary/" + std::to_string(++temporaries_);
    }

private:
    static std::string key(const Path& file) {
        std::string text = file.lexically_normal().generic_string();
        while (text.ends_with('/')) text.pop_back();
        return text;
    }
    mutable std::mutex mutex_;
    std::map<std::string, std::string> files_;
    std::size_t temporaries_ = 0;
};
MemoryFiles& memory_files() {
    static MemoryFiles files;
    return files;
}

void rename_file(const Path& from, const Path& to) {
    if (is_memory(from)) return memory_files().rename(from, to);
    if (::rename(from.c_str(), to.c_str()) != 0)
        fail_work(to.string(), "cannot be written: " + reason(), "check the rights of its folder");
}

/// Whether the path lies in the folder lexically, without resolving links.
bool is_below(const Path& file, const Path& folder) {
    std::error_code code;
    const auto absolute_path = [&](const Path& path) { return std::filesystem::absolute(path, code).lexically_normal(); };
    const Path relative = absolute_path(file).lexically_relative(absolute_path(folder));
    return !relative.empty() && *relative.begin() != "..";
}

/// The target of a chain of links, whether it exists or not.
Path resolve_links(Path file) {
    std::error_code code;
    for (int step = 0; step < 40 && std::filesystem::is_symlink(file, code); ++step) {
        // The target of a link to a device or a pipe need not be a path.
        if (std::filesystem::exists(file, code) && !std::filesystem::is_regular_file(file, code)) break;
        const Path target = std::filesystem::read_symlink(file, code);
        if (code) break;
        file = target.is_absolute() ? target : file.parent_path() / target;
    }
    return file;
}
}  // namespace

bool is_memory(const Path& file) { return file.native().starts_with("memory:"); }

void remove_memory_files(const Path& file) {
    memory_files().remove(file);
    for (const std::string& name : memory_files().below(file)) memory_files().remove(file / name);
}

bool file_exists(const Path& file) {
    std::error_code code;
    return is_memory(file) ? memory_files().find(file).has_value() : std::filesystem::is_regular_file(file, code);
}

std::size_t size_of_file(const Path& file) {
    std::error_code code;
    if (is_memory(file)) return memory_files().find(file).value_or("").size();
    const auto size = std::filesystem::file_size(file, code);
    return code ? 0 : size;
}

bool is_folder(const Path& folder) {
    std::error_code code;
    return is_memory(folder) ? !memory_files().below(folder).empty() : std::filesystem::is_directory(folder, code);
}

std::vector<std::string> files_in(const Path& folder, std::vector<std::string>* other_entries) {
    std::vector<std::string> names;
    if (is_memory(folder)) {
        for (std::string& name : memory_files().below(folder))
            if (name.find('/') == std::string::npos) names.push_back(std::move(name));
        return names;
    }
    std::error_code code;
    for (std::filesystem::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        std::error_code entry_error;
        const std::filesystem::file_status status = entry->status(entry_error);
        if (std::filesystem::is_regular_file(status)) names.push_back(entry->path().filename().string());
        else if (other_entries != nullptr && !std::filesystem::is_directory(status))
            other_entries->push_back(entry->path().filename().string());
    }
    if (code) fail_work(folder.string(), "the folder cannot be read: " + code.message(), "check its rights");
    std::sort(names.begin(), names.end());
    if (other_entries != nullptr) std::sort(other_entries->begin(), other_entries->end());
    return names;
}

void make_folder(const Path& folder) {
    if (is_memory(folder) || folder.empty()) return;
    WriteScope::check(folder);
    std::error_code code;
    std::vector<Path> created;
    for (Path ancestor = folder; !ancestor.empty() && !std::filesystem::exists(ancestor, code); ancestor = ancestor.parent_path())
        created.push_back(ancestor);
    std::filesystem::create_directories(folder, code);
    if (open_transaction != nullptr) {
        const std::lock_guard lock(pending_mutex);
        open_transaction->created_.insert(open_transaction->created_.end(), created.rbegin(), created.rend());
        for (const Path& path : created) temporary_folders().add_created(path);
    }
    if (code || !std::filesystem::is_directory(folder, code))
        fail_work(folder.string(), "the folder cannot be made" + (code ? ": " + code.message() : ""), "choose another one");
}

void remove_file(const Path& file) {
    std::error_code code;
    if (is_memory(file)) memory_files().remove(file);
    else std::filesystem::remove(file, code);
}

ReadRecord::ReadRecord() : outer_(open_record) { open_record = this; }
ReadRecord::~ReadRecord() { open_record = outer_; }

namespace {
std::string recorded(const Path& file, std::string bytes) {
    if (open_record == nullptr) return bytes;
    auto& files = open_record->files;
    if (std::none_of(files.begin(), files.end(), [&](const auto& entry) { return entry.file == file; }))
        files.push_back({file, sha256(bytes)});
    return bytes;
}

std::string read_memory(const Path& file) {
    auto bytes = memory_files().find(file);
    if (!bytes) fail_input(file.string(), "is not in memory", "check the name");
    return std::move(*bytes);
}
}  // namespace

void check_readable(const Path& file) {
    if (!is_memory(file)) const Input input(file);
    else if (!file_exists(file)) static_cast<void>(read_memory(file));
}

std::string read_file(const Path& file) {
    if (is_memory(file)) return recorded(file, read_memory(file));
    const Input input(file);
    std::string bytes;
    try {
        bytes.resize(static_cast<std::size_t>(input.status.st_size));
        std::size_t used = 0;
        for (;;) {
            if (used < bytes.size()) {
                const std::size_t count = input.read(bytes.data() + used, bytes.size() - used, file);
                if (count == 0) break;
                used += count;
                continue;
            }
            char extra[4096];  // for bytes appended meanwhile, and for files that report no size
            const std::size_t count = input.read(extra, sizeof extra, file);
            if (count == 0) break;
            bytes.append(extra, count);
            used = bytes.size();
        }
        bytes.resize(used);
    } catch (const std::bad_alloc&) {
        fail_work(file.string(), "does not fit into memory");
    }
    return recorded(file, std::move(bytes));
}

// Links are followed: the target of a link is replaced, not the link.
AtomicFile::AtomicFile(Path file, FileAccess access) : file_(is_memory(file) ? file : resolve_links(file)) {
    if (is_memory(file_)) return;
    WriteScope::check(file_);
    // In a folder that a command fills, the user did not name the individual files: links in it must not lead out of it.
    for (const OutputTransaction* transaction = open_transaction; transaction != nullptr; transaction = transaction->outer_)
        for (const auto& [folder, owner] : transaction->replaced_)
            if (is_below(file, folder)) require_writable_inside(file, folder);
    std::error_code code;
    if (std::filesystem::is_directory(file_, code)) fail_work(file_.string(), "is a folder", "give a file to write");
    // A device or a pipe (/dev/null, /dev/stdout) is written to, not replaced by a file.
    if (std::filesystem::exists(file_, code) && !std::filesystem::is_regular_file(file_, code)) {
        stream_ = std::fopen(file_.c_str(), "wb");
        if (stream_ == nullptr) fail_work(file_.string(), "cannot be written: " + reason(), "check its rights");
        return;
    }
    if (std::filesystem::is_symlink(file_, code)) fail_work(file_.string(), "is a link that refers to itself", "remove the link");
    mode_t rights = access == FileAccess::owner_only ? 0600 : 0666 & ~creation_mask();
    if (struct stat current_status{}; ::stat(file_.c_str(), &current_status) == 0) {
        if (access == FileAccess::usual) rights = current_status.st_mode & 0777;
        if (::access(file_.c_str(), W_OK) != 0)
            fail_work(file_.string(), "cannot be written: " + reason(), "check its rights, or choose another name");
    }
    // The temporary name is not derived from the file's name, which may already have the maximum length.
    const auto [temporary, descriptor] = open_temporary(file_.parent_path());
    if (descriptor < 0) {
        const std::string why = reason();
        fail_work(file_.string(), "cannot be written: " + why, "check that its folder exists and may be written to");
    }
    temporary_ = temporary;
    ::fchmod(descriptor, rights);
    stream_ = ::fdopen(descriptor, "wb");
    if (stream_ == nullptr) {
        const std::string why = reason();
        ::close(descriptor);
        ::unlink(temporary_.c_str());
        release_temporary(temporary_);
        fail_work(file_.string(), "cannot be written: " + why);
    }
}

AtomicFile::~AtomicFile() {
    if (stream_ != nullptr) {
        std::fclose(stream_);
        if (temporary_.empty()) return;
        ::unlink(temporary_.c_str());
        release_temporary(temporary_);
    }
}

void AtomicFile::write(std::string_view bytes) {
    if (is_memory(file_)) {
        memory_ += bytes;
        return;
    }
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size())
        fail_work(file_.string(), "cannot be written: " + reason(), "free some space; an earlier file of that name is untouched");
}

void AtomicFile::commit() {
    if (is_memory(file_)) {
        temporary_ = open_transaction == nullptr ? file_ : memory_files().temporary();
        memory_files().put(temporary_, std::move(memory_));
        if (open_transaction != nullptr) add_pending(open_transaction->pending_, temporary_, file_);
        return;
    }
    const bool direct = temporary_.empty();
    // The temporary file stays locked until it is renamed.
    const int lock = direct ? -1 : ::fcntl(::fileno(stream_), F_DUPFD_CLOEXEC, 0);
    const bool flushed = std::fflush(stream_) == 0 && (direct || ::fsync(::fileno(stream_)) == 0);
    const std::string why = flushed ? "" : reason();
    const bool closed = std::fclose(stream_) == 0;
    stream_ = nullptr;
    if (flushed && closed && !direct && open_transaction != nullptr)
        return add_pending(open_transaction->pending_, keep_temporary(temporary_, lock), file_);
    bool failed = !flushed || !closed;
    if (!failed && !direct) {
        const std::shared_lock naming(naming_mutex);
        failed = ::rename(temporary_.c_str(), file_.c_str()) != 0;
    }
    const std::string cause = flushed ? reason() : why;
    if (failed && !direct) ::unlink(temporary_.c_str());
    if (!direct) release_temporary(temporary_);
    if (lock >= 0) ::close(lock);
    if (failed)
        fail_work(file_.string(), "cannot be written: " + cause, "free some space; an earlier file of that name is untouched");
}

OutputTransaction::OutputTransaction() : outer_(open_transaction) { open_transaction = this; }

OutputTransaction::~OutputTransaction() {
    open_transaction = outer_;
    for (const auto& [temporary, file] : pending_) {
        remove_file(temporary);
        release_temporary(temporary);
    }
    std::error_code code;  // for folders that are not empty
    for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) std::filesystem::remove(*folder, code);
    temporary_folders().forget_created(created_);
}

OutputTransaction* current_transaction() { return open_transaction; }
TransactionScope::TransactionScope(OutputTransaction* transaction) : outer_(open_transaction) { open_transaction = transaction; }
TransactionScope::~TransactionScope() { open_transaction = outer_; }
ProtectedInputs::ProtectedInputs(std::vector<Path> files) : outer_(std::move(protected_inputs)) {
    protected_inputs = std::move(files);
}
ProtectedInputs::~ProtectedInputs() { protected_inputs = std::move(outer_); }

namespace {
/// An existing file that is about to be replaced; a hard link keeps it during the lifetime of this object.
struct Replaced {
    explicit Replaced(Path name) : file(std::move(name)) {
        struct stat current_status {};
        if (::lstat(file.c_str(), &current_status) != 0) return;
        existed = true;
        std::string pattern = (file.parent_path() / ".ostraka-XXXXXX").string();
        const int descriptor = ::mkstemp(pattern.data());
        if (descriptor < 0) return;
        ::close(descriptor);
        ::unlink(pattern.c_str());
        if (::link(file.c_str(), pattern.c_str()) == 0) backup = pattern;
    }
    ~Replaced() { remove_file(backup); }
    Replaced(const Replaced&) = delete;
    Replaced& operator=(const Replaced&) = delete;
    void restore() const {
        if (!backup.empty()) ::rename(backup.c_str(), file.c_str());
        else if (!existed) remove_file(file);
    }

    Path file, backup;
    bool existed = false, was_replaced = false;
};
}  // namespace

void OutputTransaction::commit() {
    std::vector<OutputSweep> sweeps;
    for (const auto& [folder, owner] : replaced_) sweeps.emplace_back(folder, owner, pending_, protected_inputs);
    replaced_.clear();
    for (const OutputSweep& sweep : sweeps) sweep.write_list();
    // Files in memory last: renaming them cannot fail, so none of them has to be restored.
    std::stable_partition(pending_.begin(), pending_.end(), [](const auto& names) { return !is_memory(names.second); });
    std::deque<Replaced> replaced;
    std::shared_lock naming(naming_mutex);
    try {
        for (; !pending_.empty(); pending_.erase(pending_.begin())) {
            const auto& [temporary, file] = pending_.front();
            if (!is_memory(file)) replaced.emplace_back(file);
            rename_file(temporary, file);
            release_temporary(temporary);
            if (!is_memory(file)) replaced.back().was_replaced = true;
        }
    } catch (...) {
        for (auto entry = replaced.rbegin(); entry != replaced.rend(); ++entry)
            if (entry->was_replaced) entry->restore();
        throw;
    }
    temporary_folders().forget_created(std::exchange(created_, {}));
    naming.unlock();
    for (OutputSweep& sweep : sweeps) sweep.remove_obsolete();
}

void replace_outputs(const Path& folder, const std::string& owner) {
    if (open_transaction == nullptr) throw std::logic_error("no transaction is open");
    if (!is_memory(folder)) open_transaction->replaced_.emplace_back(folder, owner);
}

void write_file(const Path& file, std::string_view bytes, FileAccess access) {
    AtomicFile output(file, access);
    output.write(bytes);
    output.commit();
}

void abandon_outputs() {
    // Never unlocked: threads that are about to rename files wait until the process ends.
    naming_mutex.lock();  // NOLINT(bugprone-*)
    abandon_temporaries();
    temporary_folders().remove();
}

ScratchFolder::ScratchFolder(const std::string& purpose) {
    std::error_code code;
    const Path system = std::filesystem::temp_directory_path(code);
    std::string pattern = ((code ? Path("/tmp") : system) / (fmt::format("ostraka-{}-XXXXXX", purpose))).string();
    if (::mkdtemp(pattern.data()) == nullptr)
        fail_work(pattern, "the folder cannot be made: " + reason(), "check the folder for temporary files (TMPDIR)");
    path_ = pattern;
    temporary_folders().add_scratch(path_);
}

ScratchFolder::~ScratchFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
    temporary_folders().forget_scratch(path_);
}

namespace {
/// The same path for all spellings of a place, whether it exists or not.
Path canonical_spelling(const Path& file) {
    std::error_code code;
    const Path canonical = resolved(file);
    return canonical.empty() ? std::filesystem::absolute(file, code).lexically_normal() : canonical;
}
}  // namespace

bool same_place(const Path& a, const Path& b) { return canonical_spelling(a / ".") == canonical_spelling(b / "."); }

void check_outputs(const std::vector<Path>& inputs, const std::vector<Path>& outputs) {
    std::error_code code;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const Path& output = outputs[i];
        if (output.empty() || is_memory(output)) continue;
        const Path canonical_output = canonical_spelling(output);
        for (const Path& input : inputs) {
            if (input.empty() || is_memory(input)) continue;
            if (std::filesystem::equivalent(output, input, code) || canonical_output == canonical_spelling(input))
                fail_usage(fmt::format("output {} is also an input", output.string()), "choose another name for the output");
        }
        for (std::size_t j = 0; j < i; ++j)
            if (!outputs[j].empty() && canonical_output == canonical_spelling(outputs[j]))
                fail_usage("two outputs have the name " + output.string(), "give each output its own name");
        const Path folder = output.has_parent_path() ? output.parent_path() : Path(".");
        if (!std::filesystem::is_directory(folder, code))
            fail_work(output.string(), "its folder does not exist", fmt::format("create the folder {} first", folder.string()));
        if (std::filesystem::is_directory(output, code)) fail_work(output.string(), "is a folder", "give a file to write");
    }
}

std::string extension(const Path& file) { return lower_case(file.extension().string()); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
    if (context_ == nullptr || EVP_DigestInit_ex(static_cast<EVP_MD_CTX*>(context_), EVP_sha256(), nullptr) != 1)
        fail_work("SHA-256", "cannot be started");
}

Sha256::~Sha256() { EVP_MD_CTX_free(static_cast<EVP_MD_CTX*>(context_)); }

void Sha256::update(const void* data, std::size_t size) { EVP_DigestUpdate(static_cast<EVP_MD_CTX*>(context_), data, size); }

std::string Sha256::hexadecimal() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int length = 0;
    EVP_DigestFinal_ex(static_cast<EVP_MD_CTX*>(context_), digest, &length);
    std::string text;
    for (unsigned int i = 0; i < length; ++i) {
        text += "0123456789abcdef"[digest[i] >> 4];
        text += "0123456789abcdef"[digest[i] & 15];
    }
    return text;
}

std::string sha256(std::string_view bytes) {
    Sha256 hash;
    hash.update(bytes.data(), bytes.size());
    return hash.hexadecimal();
}

std::string sha256_of_file(const Path& file) {
    if (is_memory(file)) return sha256(read_memory(file));
    const Input input(file);
    Sha256 hash;
    std::vector<char> buffer(1 << 20);
    while (const std::size_t size = input.read(buffer.data(), buffer.size(), file)) hash.update(buffer.data(), size);
    return hash.hexadecimal();
}

}  // namespace ostraka
