// Means, deviations and quantiles of numbers, with and without weights.
#pragma once

#include <optional>
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

/// Of a sample drawn from a population.
struct Summary {
    std::size_t count = 0;
    double mean = 0, min = 0, max = 0, median = 0;
    std::optional<double> deviation;  ///< standard deviation with count - 1 below the line; none of a single value
    std::optional<double> variation;  ///< coefficient of variation, deviation / |mean|; none where the mean is 0
};

/// Throws Error (input), naming `where`, if there is no value or one is not finite.
Summary summarise(const std::vector<double>& values, const std::string& where = "values");

/// The quantile of a sample with linear interpolation between its order statistics (type 7 of Hyndman and Fan 1996): 0 gives the
/// least, 1 the largest, 0.5 the median. Throws as above, and Error (usage) for a share outside 0 to 1.
double sample_quantile(std::vector<double> values, double share, const std::string& where = "values");

/// The value in the middle of the order, of an even number the upper of the two there. At least one value.
double upper_median(std::vector<double> values);

/// Throws Error (input), naming `where` and the value's place, unless all values are finite.
void require_finite(const std::vector<double>& values, const std::string& where);

}  // namespace ostraka
