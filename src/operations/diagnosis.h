// A diagnosis of a mesh in reports.
#pragma once

#include "ostraka/framework/report.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Declares the report values that `to_json` writes for a diagnosis.
void declare_diagnosis(ReportLayout& layout);

/// Counts, topology, size and defects of a mesh; lists (components, border loops) are truncated after one hundred entries, and
/// marked as truncated.
JsonValue to_json(const MeshDiagnosis& diagnosis, JsonAllocator& allocator);

/// Pairs of quantity and value for the printed report of a diagnosis.
std::vector<std::pair<std::string, std::string>> rows_of(const MeshDiagnosis& diagnosis);

/// What a mesh file holds beside the geometry: colours, labels, texture, materials, images, values.
std::vector<std::string> attributes_in_words(const MeshExtras& extras);

}  // namespace ostraka
