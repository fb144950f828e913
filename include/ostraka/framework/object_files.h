// Writes objects in memory to files.
#pragma once

#include "ostraka/framework/objects.h"

namespace ostraka {

/// Writes `object` to `file` in the format of its kind; an in-memory folder is written with all its files. Throws Error (usage)
/// that names `slot` if there is no file format for the object.
void write_object(const Object& object, const Path& file, const std::string& slot);

}  // namespace ostraka
