// Temporary files beside the files being written. A lock on the temporary file shows that the process that writes it is still
// alive: the system releases the lock when the process ends, for whatever reason.
#pragma once

#include "ostraka/files/file.h"

namespace ostraka {

/// An open temporary file.
struct TemporaryFile {
    Path name;            ///< empty if the file could not be created
    int descriptor = -1;  ///< open file descriptor; -1: the file could not be created, and errno gives the reason
};

/// Creates a temporary file in the folder. The first call for a folder also removes files left by killed runs. The temporary file
/// is locked as long as its descriptor, or a duplicate, is open; on a file system without locks, the name marks the file as not
/// locked.
TemporaryFile open_temporary(const Path& folder);

/// For a temporary file that waits to be renamed: takes over its descriptor and keeps the file locked until release_temporary.
/// Returns the name of the file, which changes if no more descriptors can be kept: the new name marks the file as not locked.
Path keep_temporary(const Path& name, int descriptor);
/// Ends the lock of keep_temporary; to be called when the temporary file has been renamed or removed.
void release_temporary(const Path& name);

/// Removes all open or kept temporary files; no more can be created after that.
void abandon_temporaries();

}  // namespace ostraka
