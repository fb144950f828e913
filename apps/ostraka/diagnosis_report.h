// A diagnosis as JSON and as a table.
#pragma once

#include "command.h"

#include "ostraka/io/diagnose.h"

namespace ostraka::app {

/// Counts, topology, size and defects; lists (components, border loops) are cut after the first hundred, and say so.
JsonValue to_json(const MeshDiagnosis& diagnosis, JsonAllocator& allocator);

/// Rows of "what" and "value".
std::vector<std::vector<std::string>> to_rows(const MeshDiagnosis& diagnosis);

/// One row a line, the values left-aligned: they are of all kinds.
void print_rows(const std::vector<std::vector<std::string>>& rows);

}  // namespace ostraka::app
