// A finding as a reproducible file: the mutations of the files of a subject.
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
/// Throws Error (input) if the file was not written by write_finding.
Finding read_finding(const Path& file);

}  // namespace ostraka::fuzz
