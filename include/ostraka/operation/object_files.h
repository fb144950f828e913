// Objects in memory as files.
#pragma once

#include "ostraka/operation/objects.h"

namespace ostraka {

/// Writes what the object would be as a file; a folder in memory with all its files. Throws Error (usage), naming `slot`, for an
/// object that is no file.
void write_object(const Object& object, const Path& file, const std::string& slot);

}  // namespace ostraka
