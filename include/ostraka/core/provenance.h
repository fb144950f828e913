// Where a result comes from: enough to make it again.
#pragma once

#include "ostraka/core/json.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Version of the toolkit, "major.minor.patch".
std::string version();

/// Written into every result file. Holds nothing that may differ between two runs of the same work: no time, host,
/// thread count or absolute path.
struct Provenance {
    std::string command;  ///< e.g. "annotation transfer"
    std::vector<std::pair<std::string, std::string>>
        options;                                              ///< as text, those that affect the result; repeated: "a; b" in JSON
    std::vector<std::pair<std::string, std::string>> inputs;  ///< file name without folder, SHA-256 of its bytes

    void add_input(const Path& file);
    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// One line for the comment of a mesh file.
    [[nodiscard]] std::string to_line() const;
};

}  // namespace ostraka
