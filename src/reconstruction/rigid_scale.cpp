#include "ostraka/reconstruction/rigid_scale.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <set>

namespace ostraka {

double rigid_scale(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
    constexpr std::size_t neighbours = 3;
    const std::size_t n = from.size();
    if (to.size() != n)
        fail_usage("there are " + std::to_string(n) + " landmarks and " + std::to_string(to.size()) + " to compare them with",
                   "give one for each");
    std::set<std::pair<std::size_t, std::size_t>> near;
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<std::size_t> order;
        for (std::size_t j = 0; j < n; ++j)
            if (j != i) order.push_back(j);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return (from[a] - from[i]).squaredNorm() < (from[b] - from[i]).squaredNorm();
        });
        order.resize(std::min<std::size_t>(order.size(), neighbours));
        for (const std::size_t j : order) near.emplace(std::min(i, j), std::max(i, j));
    }
    std::vector<std::pair<double, double>> ratios;  // with weights
    double all = 0;
    for (const auto& [i, j] : near) {
        const double before = (from[i] - from[j]).norm(), after = (to[i] - to[j]).norm();
        if (!(before > 0) || !(after > 0)) continue;
        ratios.emplace_back(after / before, before);
        all += before;
    }
    std::sort(ratios.begin(), ratios.end());
    double sum = 0;
    for (const auto& [ratio, weight] : ratios)
        if ((sum += weight) >= 0.5 * all) return ratio;
    return 0;
}

}  // namespace ostraka
