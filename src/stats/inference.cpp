#include "ostraka/stats/inference.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>
#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace ostraka {

namespace {

std::vector<double> step_up_q_values(const std::vector<double>& p, double factor) {
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!(p[i] >= 0 && p[i] <= 1))
            fail_input("p-values", fmt::format("number {} is {}", i, std::to_string(p[i])), "give numbers from 0 to 1");
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return p[a] < p[b]; });
    std::vector<double> q(p.size());
    double minimum = 1;
    for (std::size_t rank = order.size(); rank-- > 0;) {
        minimum = std::min(minimum, p[order[rank]] * factor * static_cast<double>(p.size()) / static_cast<double>(rank + 1));
        q[order[rank]] = minimum;
    }
    return q;
}

}  // namespace

std::vector<double> benjamini_hochberg(const std::vector<double>& p) { return step_up_q_values(p, 1); }

std::vector<double> benjamini_yekutieli(const std::vector<double>& p) {
    double sum = 0;
    for (std::size_t i = p.size(); i > 0; --i) sum += 1 / static_cast<double>(i);
    return step_up_q_values(p, sum);
}

double permutation_p_value(double observed, const std::vector<double>& chance) {
    std::size_t as_large = 0;
    for (const double value : chance) as_large += value >= observed ? 1 : 0;
    return static_cast<double>(1 + as_large) / static_cast<double>(1 + chance.size());
}

double normal_quantile(double p) {
    if (!(p > 0 && p < 1))
        fail_usage("a normal quantile is requested at " + std::to_string(p), "use a probability between 0 and 1");
    return boost::math::quantile(boost::math::normal(), p);
}

std::optional<Interval> deviation_interval(const std::vector<double>& values, bool relative, double confidence) {
    if (!(confidence > 0 && confidence < 1))
        fail_usage("the confidence is " + std::to_string(confidence), "use a value between 0 and 1");
    const double n = static_cast<double>(values.size()), z = normal_quantile(0.5 + confidence / 2);
    if (values.size() < 3 || !(n > z)) return std::nullopt;
    const Summary summary = summarise(values);
    if (!(*summary.standard_deviation > 0) || (relative && summary.mean == 0)) return std::nullopt;
    // Standardised: in units of the deviation, about the mean.
    std::vector<double> scaled;
    for (const double value : values) scaled.push_back((value - summary.mean) / *summary.standard_deviation);
    std::sort(scaled.begin(), scaled.end());
    // Trimmed mean: a fraction 1 / (2 sqrt(n - 4)) of the values is removed at either end.
    const double trimmed_fraction = values.size() > 4 ? std::min(0.5, 1 / (2 * std::sqrt(n - 4))) : 0.5;
    const auto cut = std::min(static_cast<std::size_t>(trimmed_fraction * n), (values.size() - 1) / 2);
    double middle = 0;
    for (std::size_t i = cut; i < scaled.size() - cut; ++i) middle += scaled[i] / static_cast<double>(scaled.size() - 2 * cut);
    double third = 0, fourth = 0;
    for (const double x : scaled) third += x * x * x, fourth += std::pow(x - middle, 4);
    // Bonett 2006, equation 4; the sum of squares is n - 1 in these units.
    const double kurtosis = n * fourth / ((n - 1) * (n - 1)), factor = n / (n - z);
    const double log_error = factor * std::sqrt((kurtosis - (n - 3) / n) / (n - 1)) / 2;
    double error = log_error, variation = 1;
    if (relative) {
        variation = *summary.standard_deviation / std::abs(summary.mean);
        const double skewness = std::sqrt(n) * third / std::pow(n - 1, 1.5) * (summary.mean < 0 ? -1 : 1);
        const double square = log_error * log_error + variation * variation / n - skewness * variation / n;
        error = std::sqrt(std::max(square, log_error * log_error / 4));
    }
    const double centre = std::sqrt(factor) * (relative ? variation : *summary.standard_deviation);
    return Interval{centre * std::exp(-z * error), centre * std::exp(z * error)};
}

std::vector<ClusterStability> cluster_stability(const std::vector<int>& labels,
                                                const std::function<std::vector<int>(const std::vector<std::size_t>&)>& cluster,
                                                const StabilityOptions& options) {
    check_options(options, "stability of clusters");
    std::map<int, ClusterStability> clusters;
    for (const int label : labels)
        if (label >= 0) {
            clusters[label].cluster = label;
            ++clusters[label].size;
        }
    const std::size_t n = labels.size();
    const auto part = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(options.share * static_cast<double>(n))));
    std::vector<std::map<int, double>> overlaps(static_cast<std::size_t>(n == 0 ? 0 : options.resamples));
    parallel_for(overlaps.size(), 1, [&](std::size_t r) {
        std::vector<std::size_t> resample = Random(options.seed, r).permutation(n);
        resample.resize(part);
        std::sort(resample.begin(), resample.end());
        const std::vector<int> new_labels = cluster(resample);
        if (new_labels.size() != resample.size())
            fail_usage(fmt::format("clustering gave {} labels for {} samples", new_labels.size(), resample.size()));
        std::map<int, double> old_sizes, new_sizes;
        std::map<std::pair<int, int>, double> shared;
        for (std::size_t i = 0; i < new_labels.size(); ++i) {
            const int old_label = labels[resample[i]];
            if (old_label >= 0) old_sizes[old_label] += 1;
            if (new_labels[i] >= 0) new_sizes[new_labels[i]] += 1;
            if (old_label >= 0 && new_labels[i] >= 0) shared[{old_label, new_labels[i]}] += 1;
        }
        for (const auto& [name, size] : old_sizes) overlaps[r][name] = 0;
        for (const auto& [names, common] : shared) {
            double& best = overlaps[r][names.first];
            best = std::max(best, common / (old_sizes[names.first] + new_sizes[names.second] - common));
        }
    });
    for (const auto& resample : overlaps)
        for (const auto& [name, overlap] : resample) {
            ClusterStability& stability = clusters[name];
            ++stability.resamples;
            stability.jaccard += overlap;
            stability.recovered += overlap > 0.75 ? 1 : 0;
            stability.dissolved += overlap <= 0.5 ? 1 : 0;
        }
    std::vector<ClusterStability> result;
    for (auto& [name, stability] : clusters) {
        if (stability.resamples > 0) {
            stability.jaccard /= stability.resamples;
            stability.recovered /= stability.resamples;
            stability.dissolved /= stability.resamples;
        }
        result.push_back(stability);
    }
    return result;
}

void StabilityOptions::declare_options(OptionList& list) {
    list("stability-resamples", resamples, "number of resamples from which the stability of the groups is estimated",
         Range{1, 100000});
    list("stability-share", share, "share of the objects that each resample contains", Range{0.05, 1});
    list("seed", seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka
