#include "ostraka/reconstruction/rigid_scale.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace ostraka {

namespace {

struct WeightedValue {
    double value = 0, weight = 0;
};

/// Ratios of the distances between nearby landmarks, weighted by their distance in `from`.
std::vector<WeightedValue> near_ratios(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
    constexpr std::size_t neighbours = 3;
    const std::size_t n = from.size();
    if (to.size() != n)
        fail_usage(fmt::format("there are {} landmarks, but {} to compare them with", n, to.size()), "give one for each");
    std::set<std::pair<std::size_t, std::size_t>> near_pairs;
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<std::size_t> order;
        for (std::size_t j = 0; j < n; ++j)
            if (j != i) order.push_back(j);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return (from[a] - from[i]).squaredNorm() < (from[b] - from[i]).squaredNorm();
        });
        order.resize(std::min<std::size_t>(order.size(), neighbours));
        for (const std::size_t j : order) near_pairs.emplace(std::min(i, j), std::max(i, j));
    }
    std::vector<WeightedValue> ratios;
    for (const auto& [i, j] : near_pairs) {
        const double before = (from[i] - from[j]).norm(), after = (to[i] - to[j]).norm();
        if (before > 0 && after > 0) ratios.push_back({after / before, before});
    }
    return ratios;
}

/// 0 for an empty list.
double weighted_median(std::vector<WeightedValue> values) {
    std::sort(values.begin(), values.end(), [](const WeightedValue& a, const WeightedValue& b) {
        return std::make_pair(a.value, a.weight) < std::make_pair(b.value, b.weight);
    });
    double total = 0, sum = 0;
    for (const WeightedValue& entry : values) total += entry.weight;
    for (const WeightedValue& entry : values)
        if ((sum += entry.weight) >= 0.5 * total) return entry.value;
    return 0;
}

}  // namespace

double rigid_scale(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
    return weighted_median(near_ratios(from, to));
}

std::optional<double> rigid_strain(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
    constexpr std::size_t min_landmarks = 6;
    std::vector<WeightedValue> ratios = near_ratios(from, to);
    if (from.size() < min_landmarks || ratios.size() < min_landmarks) return {};
    const double scale = weighted_median(ratios);
    for (WeightedValue& ratio : ratios) ratio.value = std::abs(ratio.value / scale - 1);
    return weighted_median(std::move(ratios));
}

}  // namespace ostraka
