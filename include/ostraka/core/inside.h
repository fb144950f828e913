// Names in files that name other files.
#pragma once

#include "ostraka/core/file.h"

#include <string>

namespace ostraka {

/// Throws Error (input) for a name that holds a zero byte, which no file can have. `where` is the file, `at` the place in it.
void require_file_name(const std::string& name, const std::string& where, const std::string& at);

/// Where `name`, found in a file of `folder`, leads. Throws Error (input) with `remedy` unless that is within the folder, also
/// over links: no absolute name, and none that climbs out of it. `whose` is the folder in the message.
Path file_inside(const std::string& name, const Path& folder, const std::string& where, const std::string& at,
                 const std::string& whose, const std::string& remedy);

}  // namespace ostraka
