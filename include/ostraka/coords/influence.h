// How much each vertex of a cage has to say where.
#pragma once

#include "ostraka/coords/coordinates.h"

#include <vector>

namespace ostraka {

enum class InfluenceBy { max, sum };

/// For each cage vertex its largest weight (what the thesis, section 5.2.3, compares with a threshold) or the sum of its weights
/// over the given points. Throws Error (usage) for an index out of range, Error (input) if there are no points.
std::vector<double> influence_on(const Coordinates& coordinates, const std::vector<Index>& points,
                                 InfluenceBy by = InfluenceBy::max);

/// The weights of one cage vertex, one a point. Throws Error (usage) for an index out of range.
std::vector<double> influence_of(const Coordinates& coordinates, Index cage_vertex);

/// For each point the number of its weights that carry `share` of the sum of their absolute values, largest first.
std::vector<Index> carriers(const WeightMatrix& weights, double share = 0.95);

}  // namespace ostraka
