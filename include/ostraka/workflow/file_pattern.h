// Patterns of file names.
#pragma once

#include "ostraka/core/file.h"

#include <functional>
#include <vector>

namespace ostraka {

/// The folder that a pattern without ".." behind a wildcard begins with.
Path before_wildcards(const Path& pattern);

/// The paths, in order, that a pattern with * and ? in its parts names. A folder with several names (links) counts once; those
/// that `may_enter` refuses do not count.
std::vector<Path> matching_files(const Path& pattern, const std::function<bool(const Path&)>& may_enter = {});

}  // namespace ostraka
