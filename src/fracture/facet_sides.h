// Classifies the sides of a wall as outer and inner.
#pragma once

#include "ostraka/fracture/facet_graph.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Cosine of the angle between each patch's normal and the direction away from the object's axis of rotation or, without an axis,
/// from the middle of the object; both are estimated from the patches `sides`. `notes` report the method.
std::vector<double> outwardness(const Mesh& mesh, const FacetGraph& graph, const std::vector<Index>& sides,
                                std::vector<std::string>& notes);

/// Weighted median of (value, weight) pairs; 0 if there are no pairs.
double weighted_median(std::vector<std::pair<double, double>> values);

}  // namespace ostraka
