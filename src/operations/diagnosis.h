// A diagnosis of a mesh in reports.
#pragma once

#include "ostraka/io/diagnose.h"
#include "ostraka/operation/report.h"

namespace ostraka {

/// The values that `to_json` has.
void declare_diagnosis(ReportLayout& layout);

/// Counts, topology, size and defects; lists (components, border loops) are cut after the first hundred, and say so.
JsonValue to_json(const MeshDiagnosis& diagnosis, JsonAllocator& allocator);

/// "what" and "value", for people.
std::vector<std::pair<std::string, std::string>> rows_of(const MeshDiagnosis& diagnosis);

}  // namespace ostraka
