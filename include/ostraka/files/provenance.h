// Provenance of a result: the information needed to reproduce it.
#pragma once

#include "ostraka/files/json.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Version of the toolkit, "major.minor.patch".
std::string version();

/// Written into every result file. Contains nothing that may differ between two runs of the same work: no time, host name,
/// number of threads or absolute path.
struct Provenance {
    std::string command;  ///< e.g. "annotation transfer"
    std::vector<std::pair<std::string, std::string>>
        options;  ///< options that affect the result, as text; repeated: "a; b" in JSON
    std::vector<std::pair<std::string, std::string>> inputs;  ///< file name without folder, SHA-256 of its bytes

    void add_input(const Path& file);
    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// One line for the comment in a mesh file.
    [[nodiscard]] std::string to_line() const;
};

}  // namespace ostraka
