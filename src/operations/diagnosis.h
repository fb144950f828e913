// A diagnosis of a mesh in reports.
#pragma once

#include "ostraka/io/diagnose.h"
#include "ostraka/operation/report.h"

namespace ostraka {

/// The values that `add_diagnosis` adds.
void declare_diagnosis(ReportLayout& layout);

/// Counts, topology, size and defects as values of a result; lists (components, border loops) are cut after the first hundred,
/// and say so.
void add_diagnosis(Report& report, const MeshDiagnosis& diagnosis);
/// The same as one structure.
JsonValue to_json(const MeshDiagnosis& diagnosis, JsonAllocator& allocator);

/// "what" and "value", for people.
std::vector<std::pair<std::string, std::string>> rows_of(const MeshDiagnosis& diagnosis);

}  // namespace ostraka
