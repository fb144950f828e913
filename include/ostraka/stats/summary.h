// Means, standard deviations and quantiles, with and without weights.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Statistics of weighted values; the median and the percentiles are quantiles of the weighted distribution.
struct Statistics {
    std::size_t count = 0;           ///< number of values
    double weight = 0;               ///< sum of the weights; if the weights are areas of faces, the total area
    double integral = 0;             ///< sum of the products of value and weight
    double mean = 0, deviation = 0;  ///< weighted mean and standard deviation
    double min = 0, max = 0, median = 0;
    double percentile_5 = 0, percentile_25 = 0, percentile_75 = 0, percentile_95 = 0;
};

/// Statistics of values with weights. Values of weight zero are ignored, also for min and max, unless all weights are zero
/// (then all weights are 1). Throws Error (input), naming `where`, if there is no value, a value is not finite, or a weight is
/// negative or not finite.
Statistics statistics(const std::vector<double>& values, const std::vector<double>& weights, const std::string& where = "map");

/// Weighted quantile: the smallest value up to which the cumulative weight reaches `fraction` (0 to 1); if the weight is reached
/// exactly, the mean of this value and the next. Throws the errors of `statistics`.
double quantile(const std::vector<double>& values, const std::vector<double>& weights, double fraction,
                const std::string& where = "map");

/// Statistics of a sample drawn from a population.
struct Summary {
    std::size_t count = 0;
    double mean = 0, min = 0, max = 0, median = 0;
    std::optional<double> standard_deviation;        ///< with divisor count - 1; empty for a single value
    std::optional<double> coefficient_of_variation;  ///< standard_deviation / |mean|; empty if the mean is 0
};

/// Statistics of a sample. Throws Error (input), naming `where`, if there is no value or a value is not finite.
Summary summarise(const std::vector<double>& values, const std::string& where = "values");

/// Sample quantile with linear interpolation between order statistics (type 7 of Hyndman and Fan 1996): fraction 0 gives the
/// minimum, 1 the maximum, 0.5 the median. Throws the errors of `summarise`, and Error (usage) for a fraction outside 0 to 1.
double sample_quantile(std::vector<double> values, double fraction, const std::string& where = "values");

/// The median; for an even number of values, the upper of the two middle values. Needs at least one value.
double upper_median(std::vector<double> values);

/// Throws Error (input), naming `where` and the index of the value, if a value is not finite.
void require_finite(const std::vector<double>& values, const std::string& where);

}  // namespace ostraka
