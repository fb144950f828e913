// Patterns of file names.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <vector>

namespace ostraka {

/// The leading folder of a pattern, up to the first part with a wildcard. The pattern must not contain ".." after a wildcard.
Path before_wildcards(const Path& pattern);

/// The paths that match a pattern with the wildcards * and ? in its parts, sorted. A folder reachable under several names (links)
/// is searched once; folders for which `may_enter` returns false are skipped.
std::vector<Path> matching_files(const Path& pattern, const std::function<bool(const Path&)>& may_enter = {});

}  // namespace ostraka
