// Statistics of values on a mesh over a region.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/stats/summary.h"

#include <string>
#include <vector>

namespace ostraka {

/// Checks the faces of a region. Throws Error (usage) for the index of a face that the mesh does not have.
void check_region(const Mesh& mesh, const std::vector<Index>& faces);

/// Statistics of vertex values over a region, weighted by area: each selected face adds a third of its area to the weight of
/// each of its corners. Throws Error (input) unless the map has one value per vertex, finite on the region, and Error (usage)
/// for a region without faces or a face out of range.
Statistics vertex_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                             const std::string& where = "map");

}  // namespace ostraka
