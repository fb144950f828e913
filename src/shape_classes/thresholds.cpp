#include "ostraka/shape_classes/thresholds.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>

#include <cmath>
#include <limits>

namespace ostraka {

namespace {

/// Inverse of the trigamma function at `y` > 0, by bisection of the logarithm (the function decreases).
double inverse_trigamma(double y) {
    double low = 1e-8, high = 1e8;
    for (int i = 0; i < 200; ++i) {
        const double middle = std::sqrt(low * high);
        (boost::math::trigamma(middle) > y ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

constexpr double max_freedom = 1e6;  ///< degrees of freedom above which Student's distribution is treated as normal

}  // namespace

SampleMoments moments_of(std::span<const double> values) {
    SampleMoments result;
    result.count = values.size();
    if (values.empty()) return result;
    const auto n = static_cast<double>(values.size());
    for (const double x : values) result.mean += x / n;
    result.freedom = n - 1;
    for (const double x : values) result.variance += (x - result.mean) * (x - result.mean);
    result.variance = n > 1 ? result.variance / (n - 1) : 0;
    return result;
}

PredictionInterval predict(const SampleMoments& moments, bool one_sided, double reject, double resolution) {
    if (moments.count == 0 || !(moments.freedom > 0))
        fail_usage(fmt::format("no prediction is possible from {} values", moments.count), "give at least two values");
    if (!(reject > 0) || !(reject < 1)) fail_usage("the share to be rejected must be between 0 and 1", "use, for example, 0.05");
    const double tail_probability = one_sided ? reject : reject / 2;
    const double t =
        moments.freedom < max_freedom
            ? boost::math::quantile(
                  boost::math::complement(boost::math::students_t_distribution<double>(moments.freedom), tail_probability))
            : boost::math::quantile(boost::math::complement(boost::math::normal_distribution<double>(), tail_probability));
    const double half_width =
        t * std::sqrt((moments.variance + resolution * resolution) * (1 + 1 / static_cast<double>(moments.count)));
    return {moments.mean - half_width, moments.mean + half_width};
}

SampleMoments VariancePrior::moderate(const SampleMoments& sample) const {
    SampleMoments result = sample;
    if (std::isinf(freedom)) {
        result.variance = variance;
        result.freedom = freedom;
        return result;
    }
    result.freedom = freedom + sample.freedom;
    result.variance = (freedom * variance + sample.freedom * sample.variance) / result.freedom;
    return result;
}

std::optional<VariancePrior> variance_prior(std::span<const SampleMoments> samples) {
    using boost::math::digamma;
    using boost::math::trigamma;
    std::vector<double> logs, expected;
    for (const SampleMoments& sample : samples) {
        if (!(sample.variance > 0) || !(sample.freedom > 0)) continue;
        logs.push_back(std::log(sample.variance) - digamma(sample.freedom / 2) + std::log(sample.freedom / 2));
        expected.push_back(trigamma(sample.freedom / 2));
    }
    if (logs.size() < 3) return {};
    const auto n = static_cast<double>(logs.size());
    double mean = 0, excess = 0;
    for (const double x : logs) mean += x / n;
    for (std::size_t i = 0; i < logs.size(); ++i) excess += (logs[i] - mean) * (logs[i] - mean) / (n - 1) - expected[i] / n;
    if (!(excess > 0)) return VariancePrior{std::exp(mean), std::numeric_limits<double>::infinity()};
    const double half = inverse_trigamma(excess);
    return VariancePrior{std::exp(mean + digamma(half) - std::log(half)), 2 * half};
}

}  // namespace ostraka
