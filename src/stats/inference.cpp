#include "ostraka/stats/inference.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace ostraka {

namespace {

std::vector<double> stepped_up(const std::vector<double>& p, double factor) {
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!(p[i] >= 0 && p[i] <= 1))
            fail_input("p-values", "number " + std::to_string(i) + " is " + std::to_string(p[i]), "give numbers from 0 to 1");
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return p[a] < p[b]; });
    std::vector<double> q(p.size());
    double least = 1;
    for (std::size_t rank = order.size(); rank-- > 0;) {
        least = std::min(least, p[order[rank]] * factor * static_cast<double>(p.size()) / static_cast<double>(rank + 1));
        q[order[rank]] = least;
    }
    return q;
}

}  // namespace

std::vector<double> benjamini_hochberg(const std::vector<double>& p) { return stepped_up(p, 1); }

std::vector<double> benjamini_yekutieli(const std::vector<double>& p) {
    double sum = 0;
    for (std::size_t i = p.size(); i > 0; --i) sum += 1 / static_cast<double>(i);
    return stepped_up(p, sum);
}

double permutation_p_value(double observed, const std::vector<double>& chance) {
    std::size_t as_large = 0;
    for (const double value : chance) as_large += value >= observed ? 1 : 0;
    return static_cast<double>(1 + as_large) / static_cast<double>(1 + chance.size());
}

double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double p) {
    if (!(p > 0 && p < 1)) fail_usage("a normal quantile at " + std::to_string(p), "use a probability between 0 and 1");
    return boost::math::quantile(boost::math::normal(), p);
}

std::optional<Interval> bootstrap_interval(std::size_t count, const SampleStatistic& statistic, const BootstrapOptions& options) {
    check_options(options, "bootstrap");
    if (count < 2) return std::nullopt;
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    const std::optional<double> observed = statistic(all);
    if (!observed) return std::nullopt;

    const auto resamples = static_cast<std::size_t>(options.resamples);
    std::vector<std::optional<double>> drawn(resamples), without(count);
    parallel_for(
        resamples, [&](std::size_t b) { drawn[b] = statistic(Random(options.seed, b).resample(count)); }, 16);
    parallel_for(
        count,
        [&](std::size_t i) {
            std::vector<std::size_t> rest = all;
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
            without[i] = statistic(rest);
        },
        16);
    std::vector<double> values, left_out;
    for (const auto& value : drawn)
        if (value) values.push_back(*value);
    for (const auto& value : without) {
        if (!value) return std::nullopt;
        left_out.push_back(*value);
    }
    if (2 * values.size() < resamples) return std::nullopt;
    require_finite(values, "bootstrap");

    // Efron 1987, section 3: the bias by the share of resamples below what was observed, the acceleration by the jackknife.
    double below = 0;
    for (const double value : values) below += value < *observed ? 1 : value == *observed ? 0.5 : 0;
    const double n = static_cast<double>(values.size());
    const double bias = normal_quantile(std::clamp(below / n, 0.5 / n, 1 - 0.5 / n));
    const double mean = summarise(left_out).mean;
    double squares = 0, cubes = 0;
    const double unit = std::max(std::abs(mean - *std::min_element(left_out.begin(), left_out.end())),
                                 std::abs(mean - *std::max_element(left_out.begin(), left_out.end())));
    if (unit > 0)
        for (const double value : left_out) {
            const double d = (mean - value) / unit;
            squares += d * d;
            cubes += d * d * d;
        }
    const double acceleration = squares > 0 ? cubes / (6 * std::pow(squares, 1.5)) : 0;
    const auto limit = [&](double probability) {
        const double z = bias + normal_quantile(probability), below_line = 1 - acceleration * z;
        const double at = below_line > 0 ? normal_probability(bias + z / below_line) : z > 0 ? 1.0 : 0.0;
        return sample_quantile(values, at);
    };
    const double tail = (1 - options.confidence) / 2;
    return Interval{limit(tail), limit(1 - tail)};
}

std::optional<Interval> studentised_interval(std::size_t count, const SampleEstimate& estimate, const BootstrapOptions& options) {
    check_options(options, "bootstrap");
    if (count < 2) return std::nullopt;
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    const std::optional<Estimate> observed = estimate(all);
    if (!observed || !(observed->error > 0)) return std::nullopt;
    const auto resamples = static_cast<std::size_t>(options.resamples);
    std::vector<std::optional<Estimate>> drawn(resamples);
    parallel_for(
        resamples, [&](std::size_t b) { drawn[b] = estimate(Random(options.seed, b).resample(count)); }, 16);
    std::vector<double> off;
    for (const auto& one : drawn)
        if (one && one->error > 0) off.push_back((one->value - observed->value) / one->error);
    if (2 * off.size() < resamples) return std::nullopt;
    require_finite(off, "bootstrap");
    const double tail = (1 - options.confidence) / 2;
    return Interval{observed->value - sample_quantile(off, 1 - tail) * observed->error,
                    observed->value - sample_quantile(off, tail) * observed->error};
}

std::optional<Interval> deviation_interval(const std::vector<double>& values, bool relative, const BootstrapOptions& options) {
    if (values.size() < 3) return std::nullopt;
    const Summary summary = summarise(values);
    if (!(*summary.deviation > 0) || (relative && summary.mean == 0)) return std::nullopt;
    // In units of the deviation, about the mean.
    std::vector<double> scaled;
    for (const double value : values) scaled.push_back((value - summary.mean) / *summary.deviation);
    const double mean = summary.mean / *summary.deviation;
    const auto estimate = [&](const std::vector<std::size_t>& chosen) -> std::optional<Estimate> {
        const double n = static_cast<double>(chosen.size());
        double sum = 0, square = 0;
        for (const std::size_t i : chosen) sum += scaled[i], square += scaled[i] * scaled[i];
        const double shift = sum / n, variance = (square - sum * shift) / (n - 1), centre = mean + shift;
        // A resample of one value over and over has no deviation.
        if (!(variance > 1e-12) || (relative && centre == 0)) return std::nullopt;
        // The influence function of log s is ((x - m)^2 / s^2 - 1) / 2, of log |m| it is (x - m) / m.
        double error = 0;
        for (const std::size_t i : chosen) {
            const double d = scaled[i] - shift;
            const double influence = (d * d / variance - 1) / 2 - (relative ? d / centre : 0);
            error += influence * influence;
        }
        return Estimate{std::log(variance) / 2 - (relative ? std::log(std::abs(centre)) : 0), std::sqrt(error) / n};
    };
    std::optional<Interval> interval = studentised_interval(values.size(), estimate, options);
    if (!interval) return std::nullopt;
    // The coefficient of variation has no unit: the scale falls out.
    const double unit = relative ? 1 : *summary.deviation;
    return Interval{unit * std::exp(interval->low), unit * std::exp(interval->high)};
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
    parallel_for(
        overlaps.size(),
        [&](std::size_t r) {
            std::vector<std::size_t> chosen = Random(options.seed, r).permutation(n);
            chosen.resize(part);
            std::sort(chosen.begin(), chosen.end());
            const std::vector<int> found = cluster(chosen);
            if (found.size() != chosen.size())
                fail_usage("clustering gave " + std::to_string(found.size()) + " labels for " + std::to_string(chosen.size()) +
                           " samples");
            std::map<int, double> old_sizes, new_sizes;
            std::map<std::pair<int, int>, double> shared;
            for (std::size_t i = 0; i < found.size(); ++i) {
                const int before = labels[chosen[i]];
                if (before >= 0) old_sizes[before] += 1;
                if (found[i] >= 0) new_sizes[found[i]] += 1;
                if (before >= 0 && found[i] >= 0) shared[{before, found[i]}] += 1;
            }
            for (const auto& [name, size] : old_sizes) overlaps[r][name] = 0;
            for (const auto& [names, common] : shared) {
                double& best = overlaps[r][names.first];
                best = std::max(best, common / (old_sizes[names.first] + new_sizes[names.second] - common));
            }
        },
        1);
    for (const auto& resample : overlaps)
        for (const auto& [name, overlap] : resample) {
            ClusterStability& of = clusters[name];
            ++of.resamples;
            of.jaccard += overlap;
            of.recovered += overlap > 0.75 ? 1 : 0;
            of.dissolved += overlap <= 0.5 ? 1 : 0;
        }
    std::vector<ClusterStability> result;
    for (auto& [name, of] : clusters) {
        if (of.resamples > 0) {
            of.jaccard /= of.resamples;
            of.recovered /= of.resamples;
            of.dissolved /= of.resamples;
        }
        result.push_back(of);
    }
    return result;
}

}  // namespace ostraka
