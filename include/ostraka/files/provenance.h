// Provenance of a result: the information needed to reproduce it.
#pragma once

#include "ostraka/files/json.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Version of the toolkit, "major.minor.patch".
std::string version();

/// Command, options and inputs of a result; written into every result file. Provenance contains nothing that may differ between
/// two runs of the same work: no time, host name, number of threads or absolute path.
struct Provenance {
    std::string command;  ///< command that wrote the result, e.g. "annotation transfer"
    /// Options that affect the result, as text; repeated: "a; b" in JSON.
    std::vector<std::pair<std::string, std::string>> options;
    /// For each input: file name without folder, SHA-256 of the file's bytes.
    std::vector<std::pair<std::string, std::string>> inputs;

    void add_input(const Path& file);  ///< adds the file's name and checksum
    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// The provenance as one line, for the comment in a mesh file.
    [[nodiscard]] std::string to_line() const;
};

}  // namespace ostraka
