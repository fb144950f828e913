// The influence of each cage vertex on a set of points.
#pragma once

#include "ostraka/coords/coordinates.h"

#include <vector>

namespace ostraka {

enum class InfluenceMeasure { max, sum };

/// For each cage vertex the maximum of its weights (compared with a threshold in the thesis, section 5.2.3) or their sum over
/// the given points. Throws Error (usage) for an index out of range, Error (input) if there are no points.
std::vector<double> influence_on(const Coordinates& coordinates, const std::vector<Index>& points,
                                 InfluenceMeasure by = InfluenceMeasure::max);

/// The weights of one cage vertex, one per point. Throws Error (usage) for an index out of range.
std::vector<double> influence_of(const Coordinates& coordinates, Index cage_vertex);

/// For each point the smallest number of weights that carry `share` of the sum of the absolute values of its weights.
std::vector<Index> carriers(const WeightMatrix& weights, double share = 0.95);

}  // namespace ostraka
