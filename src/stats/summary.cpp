#include "ostraka/stats/summary.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// Values in ascending order with cumulative weights.
struct Distribution {
    std::vector<double> values, sums;

    Distribution(const std::vector<double>& input, const std::vector<double>& weights, const std::string& where) {
        if (input.empty()) fail_input(where, "has no values here", "choose a region with values");
        if (weights.size() != input.size())
            fail_input(where, fmt::format("has {} values and {} weights", input.size(), weights.size()),
                       "give one weight per value");
        for (std::size_t i = 0; i < input.size(); ++i) {
            if (!std::isfinite(input[i]))
                fail_input(where, fmt::format("value {} is not a finite number", i), "correct the map or choose another region");
            if (!(weights[i] >= 0 && std::isfinite(weights[i])))
                fail_input(where, fmt::format("weight {} is negative or not finite", i), "check the mesh for invalid faces");
        }
        std::vector<std::size_t> order(input.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return input[i] < input[j]; });
        const bool all_zero = std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; });
        double sum = 0;
        for (const std::size_t i : order) {
            const double weight = all_zero ? 1 : weights[i];
            if (weight == 0) continue;
            values.push_back(input[i]);
            sums.push_back(sum += weight);
        }
    }

    [[nodiscard]] double at(double fraction) const {
        const double target_weight = fraction * sums.back();
        const auto place = std::lower_bound(sums.begin(), sums.end(), target_weight) - sums.begin();
        const auto i = std::min<std::size_t>(static_cast<std::size_t>(place), values.size() - 1);
        return sums[i] == target_weight && i + 1 < values.size() ? (values[i] + values[i + 1]) / 2 : values[i];
    }
};

void require_sample(const std::vector<double>& values, const std::string& where) {
    if (values.empty()) fail_input(where, "no value is given", "give at least one value");
    require_finite(values, where);
}

/// Type 7 of Hyndman and Fan, for sorted values.
double interpolated(const std::vector<double>& sorted, double fraction) {
    const double at = fraction * static_cast<double>(sorted.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), sorted.size() - 1);
    const double remainder = at - static_cast<double>(below);
    return remainder == 0 ? sorted[below] : sorted[below] + remainder * (sorted[below + 1] - sorted[below]);
}

}  // namespace

Statistics statistics(const std::vector<double>& values, const std::vector<double>& weights, const std::string& where) {
    const Distribution sorted(values, weights, where);
    Statistics result;
    result.count = values.size();
    result.weight = sorted.sums.back();
    // About the median, to avoid cancellation for large values that are close together.
    result.median = sorted.at(0.5);
    double sum = 0, square = 0, previous_sum = 0;
    for (std::size_t i = 0; i < sorted.values.size(); ++i) {
        const double weight = sorted.sums[i] - previous_sum, deviation = sorted.values[i] - result.median;
        previous_sum = sorted.sums[i];
        sum += weight * deviation;
        square += weight * deviation * deviation;
    }
    const double shift = sum / result.weight;
    result.mean = result.median + shift;
    result.deviation = std::sqrt(std::max(0.0, square / result.weight - shift * shift));
    result.integral = result.mean * result.weight;
    result.min = sorted.values.front();
    result.max = sorted.values.back();
    result.percentile_5 = sorted.at(0.05);
    result.percentile_25 = sorted.at(0.25);
    result.percentile_75 = sorted.at(0.75);
    result.percentile_95 = sorted.at(0.95);
    return result;
}

double quantile(const std::vector<double>& values, const std::vector<double>& weights, double fraction,
                const std::string& where) {
    if (!(fraction >= 0 && fraction <= 1))
        fail_usage("a quantile is requested at " + std::to_string(fraction), "use a share from 0 to 1");
    return Distribution(values, weights, where).at(fraction);
}

void require_finite(const std::vector<double>& values, const std::string& where) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
            fail_input(where, fmt::format("value {} is not a finite number", i), "remove it, or give a finite number");
}

Summary summarise(const std::vector<double>& values, const std::string& where) {
    require_sample(values, where);
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    Summary result;
    result.count = sorted.size();
    result.min = sorted.front();
    result.max = sorted.back();
    result.median = interpolated(sorted, 0.5);
    // About the median and in units of the range, to avoid cancellation, overflow and underflow.
    const double n = static_cast<double>(result.count);
    const double unit = std::max(result.max / 2 - result.min / 2, 0.0);
    double sum = 0, square = 0;
    if (unit > 0)
        for (const double value : sorted) {
            const double deviation = (value / 2 - result.median / 2) / unit;
            sum += deviation;
            square += deviation * deviation;
        }
    result.mean = std::clamp(result.median + sum / n * 2 * unit, result.min, result.max);
    if (result.count > 1) {
        result.standard_deviation = 2 * unit * std::sqrt(std::max(0.0, square - sum * sum / n) / (n - 1));
        if (result.mean != 0) result.coefficient_of_variation = *result.standard_deviation / std::abs(result.mean);
    }
    return result;
}

double sample_quantile(std::vector<double> values, double fraction, const std::string& where) {
    if (!(fraction >= 0 && fraction <= 1))
        fail_usage("a quantile is requested at " + std::to_string(fraction), "use a share from 0 to 1");
    require_sample(values, where);
    std::sort(values.begin(), values.end());
    return interpolated(values, fraction);
}

double upper_median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace ostraka
