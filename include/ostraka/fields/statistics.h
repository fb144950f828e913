// Statistics of values on a mesh over a region.
#pragma once

#include "ostraka/core/mesh.h"

#include <string>
#include <vector>

namespace ostraka {

/// Of values with weights; quantiles are those of the weighted distribution.
struct Statistics {
    std::size_t count = 0;  ///< values
    double weight = 0;      ///< sum of the weights: the area of a region
    double integral = 0;    ///< sum of value times weight
    double mean = 0, deviation = 0;
    double min = 0, max = 0, median = 0;
    double percentile_5 = 0, percentile_25 = 0, percentile_75 = 0, percentile_95 = 0;
};

/// Values of weight zero count for min and max only if all weights are zero (then each value counts once). Throws Error
/// (input), naming `where`, if there is no value, one is not finite, or a weight is negative or not finite.
Statistics statistics(const std::vector<double>& values, const std::vector<double>& weights, const std::string& where = "map");

/// The smallest value whose share of the weight, with all smaller ones, reaches `share` (0 to 1), values halfway between two
/// averaged. Throws as above.
double quantile(const std::vector<double>& values, const std::vector<double>& weights, double share,
                const std::string& where = "map");

/// A map with one value a vertex over a region: each selected face gives a third of its area to each of its corners.
/// Throws Error (input) if the map has not one value a vertex or one in the region is not finite, and Error (usage) for a region
/// without faces or a face out of range.
Statistics vertex_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                             const std::string& where = "map");
/// The same for a map with one value a face.
Statistics face_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                           const std::string& where = "map");

}  // namespace ostraka
