// Run folders: locking, emptying, and checking for paths that lead out of the folder.
#pragma once

#include "ostraka/workflow/run.h"

#include <functional>

namespace ostraka {

/// Locks an instance's folder against other processes during its lifetime.
class FolderLock {
public:
    /// Waits for the lock until the lock is free or `stop` returns true.
    FolderLock(const Path& folder, const std::function<bool()>& stop);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    [[nodiscard]] bool waited() const { return waited_; }  ///< whether another process held the lock

private:
    int descriptor_;       ///< file descriptor that holds the lock
    bool waited_ = false;  ///< true: another process held the lock
};

/// Removes the content of a folder but keeps the folder itself, which is locked.
void empty_folder(const Path& folder);

}  // namespace ostraka
