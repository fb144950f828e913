// Statistics of values on a mesh over a region.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/stats/summary.h"

#include <string>
#include <vector>

namespace ostraka {

/// Checks the faces of a region. Throws Error (usage) for the index of a face that the mesh does not have.
void check_region(const Mesh& mesh, const std::vector<Index>& faces);

/// What NaN in a map means.
enum class UndefinedValues {
    refused,  ///< a fault of the map
    skipped   ///< no value there, such as the curvature of a border vertex
};

/// Statistics of a vertex map over a region: each selected face gives a third of its area to each of its corners. Throws Error
/// (input) unless the map has one value per vertex, finite on the region (or NaN, if these are skipped, but not everywhere), and
/// Error (usage) for a region without faces or a face out of range.
Statistics vertex_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                             const std::string& where = "map", UndefinedValues treatment = UndefinedValues::refused);

}  // namespace ostraka
