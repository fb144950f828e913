// Folders of a run: locked, emptied, and checked for what leads out of them.
#pragma once

#include "ostraka/workflow/run.h"

#include <functional>

namespace ostraka {

/// Folder of an instance that no other process works in while this lives.
class FolderLock {
public:
    /// Waits as long as another process has it, until `stop` says otherwise.
    FolderLock(const Path& folder, const std::function<bool()>& stop);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    [[nodiscard]] bool waited() const { return waited_; }

private:
    int descriptor_;
    bool waited_ = false;
};

/// Removes what a folder holds, and leaves the folder, which is locked.
void empty_folder(const Path& folder);

}  // namespace ostraka
