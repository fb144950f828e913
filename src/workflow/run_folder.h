// Run folders: locking, emptying, and checking for paths that lead out of them.
#pragma once

#include "ostraka/workflow/run.h"

#include <functional>

namespace ostraka {

/// Locks an instance's folder against other processes during its lifetime.
class FolderLock {
public:
    /// Waits for the lock until `stop` returns true.
    FolderLock(const Path& folder, const std::function<bool()>& stop);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    [[nodiscard]] bool waited() const { return waited_; }

private:
    int descriptor_;
    bool waited_ = false;
};

/// Removes the content of a folder but keeps the folder, which is locked.
void empty_folder(const Path& folder);

}  // namespace ostraka
