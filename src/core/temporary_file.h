// Temporary files beside those that are being written. A lock of the system tells whether the process that writes one still
// lives: it is free as soon as the process ends, however it ends.
#pragma once

#include "ostraka/core/file.h"

namespace ostraka {

/// An open temporary file.
struct TemporaryFile {
    Path name;
    int descriptor = -1;  ///< -1: none could be made, for the reason that errno says
};

/// Makes one in the folder, and removes what killed runs left there when this process first writes to it. The file is locked as
/// long as the descriptor, or one that was made of it, is open; where the file system knows no locks its name says so.
TemporaryFile open_temporary(const Path& folder);

/// For a file that waits to be renamed: keeps it locked by this descriptor, which now belongs to it, until release_temporary.
/// Returns its name from now on: another one where no more descriptors can be kept, which says that it is not locked.
Path keep_temporary(const Path& name, int descriptor);
/// The file has another name now, or is gone.
void release_temporary(const Path& name);

/// Removes all that are open or kept; from here on none can be made.
void abandon_temporaries();

}  // namespace ostraka
