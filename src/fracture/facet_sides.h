// Which side of a wall looks outward.
#pragma once

#include "ostraka/fracture/facet_graph.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Cosine of the angle between each patch's normal and the direction away from the object's axis of rotation or, without one, its
/// middle; told by the patches `sides`. Says how in `notes`.
std::vector<double> outwardness(const Mesh& mesh, const FacetGraph& graph, const std::vector<Index>& sides,
                                std::vector<std::string>& notes);

/// Of values with weights; 0 for none.
double weighted_median(std::vector<std::pair<double, double>> values);

}  // namespace ostraka
