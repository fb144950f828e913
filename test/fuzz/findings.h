// What was found, as a file that can be run once more: which files of a subject became what.
#pragma once

#include "mutations.h"

#include <string>
#include <vector>

namespace ostraka::fuzz {

struct Finding {
    std::string subject, kind, note;
    std::vector<Change> changes;
};

void write_finding(const Path& file, const Finding& finding);
/// Throws Error (input) for what write_finding has not written.
Finding read_finding(const Path& file);

}  // namespace ostraka::fuzz
