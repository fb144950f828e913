// Temporary files beside the files being written. A file lock shows whether the process that writes one is still alive: the
// system releases it when the process ends, for whatever reason.
#pragma once

#include "ostraka/files/file.h"

namespace ostraka {

/// An open temporary file.
struct TemporaryFile {
    Path name;
    int descriptor = -1;  ///< -1: none could be created; errno gives the reason
};

/// Creates a temporary file in the folder. The first call for a folder also removes files left by killed runs. The file is
/// locked as long as its descriptor, or a duplicate, is open; on a file system without locks, the name marks the file as not
/// locked.
TemporaryFile open_temporary(const Path& folder);

/// For a file that waits to be renamed: takes over the descriptor and keeps the file locked until release_temporary. Returns
/// the name of the file, which changes if no more descriptors can be kept: the new name marks the file as not locked.
Path keep_temporary(const Path& name, int descriptor);
/// To be called when the file has been renamed or removed.
void release_temporary(const Path& name);

/// Removes all open or kept temporary files; no more can be created after that.
void abandon_temporaries();

}  // namespace ostraka
