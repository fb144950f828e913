// Statistical inference: permutation tests, confidence intervals, false discovery rates, stability of clusters.
#pragma once

#include "ostraka/core/options.h"

#include <functional>
#include <optional>
#include <vector>

namespace ostraka {

/// For each p-value, its q-value: rejecting all hypotheses with q <= a keeps the false discovery rate below a, if the tests are
/// independent or positively dependent (Benjamini and Hochberg 1995). Throws Error (input) unless each p is from 0 to 1.
std::vector<double> benjamini_hochberg(const std::vector<double>& p);
/// For each p-value, its q-value for tests with any dependence, larger by the factor 1 + 1/2 + ... + 1/m than for independent
/// tests (Benjamini and Yekutieli 2001). Throws Error (input) unless each p is from 0 to 1.
std::vector<double> benjamini_yekutieli(const std::vector<double>& p);

/// p-value of a permutation test: (1 + number of `chance` values that are at least `observed`) / (1 + number of `chance` values),
/// never 0 (Phipson and Smyth 2010). For tests where small values are extreme, negate `observed` and `chance`.
double permutation_p_value(double observed, const std::vector<double>& chance);

/// Quantile of the standard normal distribution. Throws Error (usage) unless 0 < p < 1.
double normal_quantile(double p);

/// A confidence interval.
struct Interval {
    double low = 0, high = 0;  ///< bounds of the interval
};

/// Confidence interval of the standard deviation of a population that need not be normal (Bonett 2006), from the kurtosis about a
/// trimmed mean; with `relative`, the confidence interval of the coefficient of variation, in which the error of the mean and
/// its correlation with the error of the deviation (the third moment) are included to first order. The interval has a closed
/// form; for few values its coverage is closer to the nominal coverage than that of the bootstrap. Empty for fewer than three
/// values (more for a confidence above 0.95), for values without variation, or if the mean is 0. Throws Error (usage) unless 0
/// < confidence < 1.
std::optional<Interval> deviation_interval(const std::vector<double>& values, bool relative, double confidence = 0.95);

struct StabilityOptions {
    int resamples = 100;                     ///< number of resamples
    double share = 0.8;                      ///< share of the samples in a resample, drawn without replacement
    std::uint64_t seed = 1;                  ///< random seed
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Stability of a cluster when subsamples are clustered.
struct ClusterStability {
    int cluster = 0;       ///< label of the cluster
    std::size_t size = 0;  ///< number of samples in the cluster
    double jaccard = 0;    ///< mean over the resamples of the largest Jaccard overlap of the cluster with a new cluster
    double recovered = 0;  ///< share of the resamples with an overlap above 0.75
    double dissolved = 0;  ///< share of the resamples with an overlap of at most 0.5
    int resamples = 0;     ///< number of resamples that contain at least one sample of the cluster; 0: the stability is unknown
};

/// Stability of each cluster (labels from 0 up; labels below 0 are noise) by the method of Hennig (2007): Jaccard overlap of
/// the cluster, restricted to a resample, with the best matching cluster of the resample. `cluster` returns labels for the
/// samples of the given indices, in the order of the indices. Resamples run in parallel: `cluster` must not modify shared data.
/// Throws Error (usage) if the number of returned labels differs from the number of samples.
std::vector<ClusterStability> cluster_stability(const std::vector<int>& labels,
                                                const std::function<std::vector<int>(const std::vector<std::size_t>&)>& cluster,
                                                const StabilityOptions& options = {});

}  // namespace ostraka
