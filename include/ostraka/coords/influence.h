// The influence of each cage vertex on a set of points.
#pragma once

#include "ostraka/coords/coordinates.h"

#include <vector>

namespace ostraka {

/// How the weights of a cage vertex for several points are combined.
enum class InfluenceMeasure { max, sum };

/// Influence of each cage vertex on the points with these indices: the maximum of its weights over the points (the thesis
/// compares this maximum with a threshold, section 5.2.3) or the sum of its weights. Throws Error (usage) for an index out of
/// range, Error (input) if there are no points.
std::vector<double> influence_on(const Coordinates& coordinates, const std::vector<Index>& points,
                                 InfluenceMeasure by = InfluenceMeasure::max);

/// The weights of one cage vertex, one per point. Throws Error (usage) for an index out of range.
std::vector<double> influence_of(const Coordinates& coordinates, Index cage_vertex);

/// For each point (row), the smallest number of weights whose absolute values add up to the fraction `share` of the row's sum of
/// absolute values.
std::vector<Index> dominant_weight_counts(const WeightMatrix& weights, double share = 0.95);

}  // namespace ostraka
