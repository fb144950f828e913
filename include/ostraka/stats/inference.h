// What chance alone may explain: permutation tests, intervals, false discoveries, the stability of clusters.
#pragma once

#include "ostraka/core/options.h"

#include <functional>
#include <optional>
#include <vector>

namespace ostraka {

/// q-values of p-values: calling all with q <= a discoveries keeps the expected share of false ones below a, if the tests are
/// independent or positively dependent (Benjamini and Hochberg 1995). Throws Error (input) unless each p is from 0 to 1.
std::vector<double> benjamini_hochberg(const std::vector<double>& p);
/// The same under any dependence, larger by 1 + 1/2 + ... + 1/m (Benjamini and Yekutieli 2001).
std::vector<double> benjamini_yekutieli(const std::vector<double>& p);

/// (1 + number of `chance` that are at least `observed`) / (1 + their number): never 0 (Phipson and Smyth 2010). For tests that
/// look for small values give both negated.
double permutation_p_value(double observed, const std::vector<double>& chance);

/// The inverse of the distribution function of the standard normal distribution. Throws Error (usage) unless 0 < p < 1.
double normal_quantile(double p);

struct Interval {
    double low = 0, high = 0;
};

/// Interval of the standard deviation of a population that need not be normal (Bonett 2006), from the kurtosis about a trimmed
/// mean; with `relative` of the coefficient of variation: the error of the mean and its correlation with that of the deviation
/// (the third moment) are added to first order. In closed form, and nearer to the confidence it says than the bootstrap of few
/// values. None for fewer than three values (more for a confidence above 0.95), where nothing varies, or the mean is 0. Throws
/// Error (usage) unless 0 < confidence < 1.
std::optional<Interval> deviation_interval(const std::vector<double>& values, bool relative, double confidence = 0.95);

struct StabilityOptions {
    int resamples = 100;
    double share = 0.8;  ///< of the samples, drawn without replacement
    std::uint64_t seed = 1;
    void describe(OptionList& visit);
};

/// How a cluster fares when clusters are found in parts of the samples.
struct ClusterStability {
    int cluster = 0;
    std::size_t size = 0;
    double jaccard = 0;    ///< mean over the resamples of the best overlap with a cluster found there
    double recovered = 0;  ///< share of resamples with an overlap above 0.75
    double dissolved = 0;  ///< share with one of at most 0.5
    int resamples = 0;     ///< in which it has a sample; 0: nothing is known
};

/// Stability of each cluster (labels from 0 up; below 0 is noise) by Hennig (2007): Jaccard overlaps of what is left of it with
/// the cluster found anew that fits it best. `cluster` gives labels for the samples of the given indices, in their order.
/// Resamples run in parallel: it must not change what it shares. Throws Error (usage) if it gives another number of labels than
/// samples.
std::vector<ClusterStability> cluster_stability(const std::vector<int>& labels,
                                                const std::function<std::vector<int>(const std::vector<std::size_t>&)>& cluster,
                                                const StabilityOptions& options = {});

}  // namespace ostraka
