// Patterns of file names.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <vector>

namespace ostraka {

/// The leading folder of a pattern without wildcards. The pattern must not contain ".." after a wildcard.
Path before_wildcards(const Path& pattern);

/// The sorted paths that match a pattern with * and ? in its parts. A folder reachable under several names (links) is searched
/// once; folders for which `may_enter` is false are skipped.
std::vector<Path> matching_files(const Path& pattern, const std::function<bool(const Path&)>& may_enter = {});

}  // namespace ostraka
