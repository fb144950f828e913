#include "files/temporary_file.h"

#include "ostraka/files/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <map>
#include <mutex>
#include <set>

namespace ostraka {

namespace fs = std::filesystem;

namespace {

/// Prefixes of locked and of unlocked temporary files.
constexpr std::string_view locked_prefix = ".ostraka-held-", unlocked_prefix = ".ostraka-";
constexpr std::size_t letters = 6;
/// Maximum number of locks kept, since descriptors are limited.
constexpr std::size_t max_locks = 256;

bool is_named(const std::string& name, std::string_view prefix) {
    return name.size() == prefix.size() + letters && name.starts_with(prefix);
}

/// Whether the lock is ours and the file still exists: no other process removed it as a leftover in between.
bool still_exists(int descriptor) {
    struct stat status {};
    return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

/// Removes the temporary file if the process that locked it has ended.
bool remove_if_free(const Path& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return false;
    struct stat opened_status {
    }, named_status{};
    // The name may denote another file by now.
    const bool removed = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::fstat(descriptor, &opened_status) == 0 &&
                         ::lstat(file.c_str(), &named_status) == 0 && S_ISREG(named_status.st_mode) &&
                         opened_status.st_ino == named_status.st_ino && opened_status.st_dev == named_status.st_dev &&
                         ::unlink(file.c_str()) == 0;
    ::close(descriptor);
    return removed;
}

class TemporaryRegistry {
public:
    bool add(const Path& name, int descriptor) {
        const std::lock_guard lock(mutex_);
        return descriptors_.size() < max_locks && descriptors_.emplace(name.native(), descriptor).second;
    }
    void release(const Path& name) {
        const std::lock_guard lock(mutex_);
        names_.erase(name.native());
        const auto entry = descriptors_.find(name.native());
        if (entry == descriptors_.end()) return;
        ::close(entry->second);
        descriptors_.erase(entry);
    }
    /// Registers a created file. If all outputs were abandoned, removes the file and returns false.
    bool register_created(const Path& name) {
        const std::lock_guard lock(mutex_);
        if (abandoned_) ::unlink(name.c_str());
        else names_.insert(name.native());
        return !abandoned_;
    }
    void abandon() {
        const std::lock_guard lock(mutex_);
        abandoned_ = true;
        for (const std::string& name : names_) ::unlink(name.c_str());
        names_.clear();
    }
    /// True at the first call for each folder.
    bool is_first_use(const Path& folder) {
        const std::lock_guard lock(mutex_);
        std::error_code code;
        return folders_.insert(fs::absolute(folder, code).lexically_normal().native()).second;
    }

private:
    std::mutex mutex_;
    std::map<std::string, int> descriptors_;
    std::set<std::string> folders_, names_;
    bool abandoned_ = false;
};
TemporaryRegistry& registry() {
    static TemporaryRegistry instance;
    return instance;
}

TemporaryFile make_in(const Path& folder, std::string_view prefix) {
    std::string pattern = (folder / (std::string(prefix) + std::string(letters, 'X'))).string();
    const int descriptor = ::mkostemp(pattern.data(), O_CLOEXEC);
    if (descriptor < 0) return {{}, descriptor};
    if (registry().register_created(pattern)) return {pattern, descriptor};
    ::close(descriptor);
    errno = ECANCELED;
    return {{}, -1};
}

}  // namespace

TemporaryFile open_temporary(const Path& folder) {
    if (registry().is_first_use(folder.empty() ? Path(".") : folder))
        remove_stale_temporaries(folder.empty() ? Path(".") : folder);
    for (int attempt = 0; attempt < 100; ++attempt) {
        TemporaryFile created = make_in(folder, locked_prefix);
        if (created.descriptor < 0) return created;
        const bool locked = ::flock(created.descriptor, LOCK_EX | LOCK_NB) == 0;
        if (locked && still_exists(created.descriptor)) return created;
        const bool knows_none = !locked && errno != EWOULDBLOCK;
        ::unlink(created.name.c_str());
        registry().release(created.name);
        ::close(created.descriptor);
        if (knows_none) break;
    }
    return make_in(folder, unlocked_prefix);
}

Path keep_temporary(const Path& name, int descriptor) {
    if (descriptor >= 0 && registry().add(name, descriptor)) return name;
    Path unlocked_name = name;
    if (is_named(name.filename().string(), locked_prefix))
        if (const TemporaryFile unlocked = make_in(name.parent_path(), unlocked_prefix); unlocked.descriptor >= 0) {
            ::close(unlocked.descriptor);
            if (::rename(name.c_str(), unlocked.name.c_str()) == 0) {
                unlocked_name = unlocked.name;
                registry().release(name);
            } else {
                ::unlink(unlocked.name.c_str());
                registry().release(unlocked.name);
            }
        }
    if (descriptor >= 0) ::close(descriptor);
    return unlocked_name;
}

void release_temporary(const Path& name) { registry().release(name); }

void abandon_temporaries() { registry().abandon(); }

std::size_t remove_stale_temporaries(const Path& folder) {
    using namespace std::chrono_literals;
    std::error_code code;
    std::size_t count = 0;
    const auto now = fs::file_time_type::clock::now();
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string name = entry->path().filename().string();
        std::error_code entry_error;
        if (is_named(name, locked_prefix) && remove_if_free(entry->path())) ++count;
        if (!is_named(name, unlocked_prefix) || entry->symlink_status(entry_error).type() != fs::file_type::regular) continue;
        const auto modified = entry->last_write_time(entry_error);
        if (!entry_error && now - modified > 24h && fs::remove(entry->path(), entry_error)) ++count;
    }
    return count;
}

}  // namespace ostraka
