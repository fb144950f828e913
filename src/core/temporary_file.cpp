#include "temporary_file.h"

#include "ostraka/core/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>
#include <set>

namespace ostraka {

namespace fs = std::filesystem;

namespace {

/// Prefixes of locked and of unlocked temporary files.
constexpr std::string_view locked_beginning = ".ostraka-held-", free_beginning = ".ostraka-";
constexpr std::size_t letters = 6;
/// Maximum number of locks kept, since descriptors are limited.
constexpr std::size_t most_kept = 256;

bool is_named(const std::string& name, std::string_view beginning) {
    return name.size() == beginning.size() + letters && name.starts_with(beginning);
}

/// Whether the lock is ours and the file still exists: no other process removed it as a leftover in between.
bool is_there(int descriptor) {
    struct stat status {};
    return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

/// Removes the temporary file if the process that locked it has ended.
bool remove_if_free(const Path& file) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) return false;
    struct stat open {
    }, named{};
    // The name may denote another file by now.
    const bool gone = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && ::fstat(descriptor, &open) == 0 &&
                      ::lstat(file.c_str(), &named) == 0 && S_ISREG(named.st_mode) && open.st_ino == named.st_ino &&
                      open.st_dev == named.st_dev && ::unlink(file.c_str()) == 0;
    ::close(descriptor);
    return gone;
}

class Kept {
public:
    bool add(const Path& name, int descriptor) {
        const std::lock_guard lock(mutex_);
        return descriptors_.size() < most_kept && descriptors_.emplace(name.native(), descriptor).second;
    }
    void release(const Path& name) {
        const std::lock_guard lock(mutex_);
        names_.erase(name.native());
        const auto found = descriptors_.find(name.native());
        if (found == descriptors_.end()) return;
        ::close(found->second);
        descriptors_.erase(found);
    }
    /// Registers a created file. If all outputs were abandoned, removes the file and returns false.
    bool made(const Path& name) {
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
    bool first(const Path& folder) {
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
Kept& kept() {
    static Kept all;
    return all;
}

TemporaryFile make_in(const Path& folder, std::string_view beginning) {
    std::string pattern = (folder / (std::string(beginning) + std::string(letters, 'X'))).string();
    const int descriptor = ::mkostemp(pattern.data(), O_CLOEXEC);
    if (descriptor < 0) return {{}, descriptor};
    if (kept().made(pattern)) return {pattern, descriptor};
    ::close(descriptor);
    errno = ECANCELED;
    return {{}, -1};
}

}  // namespace

TemporaryFile open_temporary(const Path& folder) {
    if (kept().first(folder.empty() ? Path(".") : folder)) remove_stale_temporaries(folder.empty() ? Path(".") : folder);
    for (int attempt = 0; attempt < 100; ++attempt) {
        const TemporaryFile made = make_in(folder, locked_beginning);
        if (made.descriptor < 0) return made;
        const bool locked = ::flock(made.descriptor, LOCK_EX | LOCK_NB) == 0;
        if (locked && is_there(made.descriptor)) return made;
        const bool knows_none = !locked && errno != EWOULDBLOCK;
        ::unlink(made.name.c_str());
        kept().release(made.name);
        ::close(made.descriptor);
        if (knows_none) break;
    }
    return make_in(folder, free_beginning);
}

Path keep_temporary(const Path& name, int descriptor) {
    if (descriptor >= 0 && kept().add(name, descriptor)) return name;
    Path free = name;
    if (is_named(name.filename().string(), locked_beginning))
        if (const TemporaryFile other = make_in(name.parent_path(), free_beginning); other.descriptor >= 0) {
            ::close(other.descriptor);
            if (::rename(name.c_str(), other.name.c_str()) == 0) {
                free = other.name;
                kept().release(name);
            } else {
                ::unlink(other.name.c_str());
                kept().release(other.name);
            }
        }
    if (descriptor >= 0) ::close(descriptor);
    return free;
}

void release_temporary(const Path& name) { kept().release(name); }

void abandon_temporaries() { kept().abandon(); }

std::size_t remove_stale_temporaries(const Path& folder) {
    using namespace std::chrono_literals;
    std::error_code code;
    std::size_t count = 0;
    const auto now = fs::file_time_type::clock::now();
    for (fs::directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
        const std::string name = it->path().filename().string();
        std::error_code own;
        if (is_named(name, locked_beginning) && remove_if_free(it->path())) ++count;
        if (!is_named(name, free_beginning) || it->symlink_status(own).type() != fs::file_type::regular) continue;
        const auto touched = it->last_write_time(own);
        if (!own && now - touched > 24h && fs::remove(it->path(), own)) ++count;
    }
    return count;
}

}  // namespace ostraka
