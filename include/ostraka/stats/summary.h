// Means, deviations and quantiles, with and without weights.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Statistics of weighted values; quantiles are those of the weighted distribution.
struct Statistics {
    std::size_t count = 0;  ///< number of values
    double weight = 0;      ///< sum of the weights, e.g. the area of a region
    double integral = 0;    ///< sum of value times weight
    double mean = 0, deviation = 0;
    double min = 0, max = 0, median = 0;
    double percentile_5 = 0, percentile_25 = 0, percentile_75 = 0, percentile_95 = 0;
};

/// Values of weight zero are ignored, also for min and max, unless all weights are zero (then each value counts once). Throws
/// Error (input), naming `where`, if there is no value, one is not finite, or a weight is negative or not finite.
Statistics statistics(const std::vector<double>& values, const std::vector<double>& weights, const std::string& where = "map");

/// The smallest value up to which the cumulative weight reaches `fraction` (0 to 1); if exactly reached, the mean of it and the
/// next value. Throws the same errors.
double quantile(const std::vector<double>& values, const std::vector<double>& weights, double fraction,
                const std::string& where = "map");

/// Statistics of a sample drawn from a population.
struct Summary {
    std::size_t count = 0;
    double mean = 0, min = 0, max = 0, median = 0;
    std::optional<double> deviation;  ///< standard deviation with divisor count - 1; none for a single value
    std::optional<double> variation;  ///< coefficient of variation, deviation / |mean|; none if the mean is 0
};

/// Throws Error (input), naming `where`, if there is no value or one is not finite.
Summary summarise(const std::vector<double>& values, const std::string& where = "values");

/// Sample quantile with linear interpolation between order statistics (type 7 of Hyndman and Fan 1996): 0 gives the minimum, 1
/// the maximum, 0.5 the median. Throws the same errors, and Error (usage) for a share outside 0 to 1.
double sample_quantile(std::vector<double> values, double fraction, const std::string& where = "values");

/// The median; for an even number of values, the upper of the two middle ones. Needs at least one value.
double upper_median(std::vector<double> values);

/// Throws Error (input), naming `where` and the index of the value, unless all values are finite.
void require_finite(const std::vector<double>& values, const std::string& where);

}  // namespace ostraka
