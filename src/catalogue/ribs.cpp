#include "catalogue/ribs.h"

#include "ostraka/core/angles.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

using Line = CatalogueDrawing::Line;

/// Gaussian mean of the profile's radii around a row, over the rows with wall.
double smooth_radius(const std::vector<double>& radii, std::size_t row, double deviation) {
    const long reach = static_cast<long>(std::ceil(3 * deviation)), n = static_cast<long>(radii.size());
    double sum = 0, weights = 0;
    for (long k = std::max(0L, static_cast<long>(row) - reach); k <= std::min(n - 1, static_cast<long>(row) + reach); ++k) {
        const double r = radii[static_cast<std::size_t>(k)], d = (double(k) - double(row)) / deviation;
        if (r > 0) sum += std::exp(-d * d / 2) * r, weights += std::exp(-d * d / 2);
    }
    return weights > 0 ? sum / weights : 0;
}

/// Bend of the profile at a row, in radians, over a number of rows on each side; 0 where the profile is not known.
double bend(const std::vector<double>& radii, double step, std::size_t row, std::size_t window) {
    if (row < window || row + window >= radii.size()) return 0;
    const double a = radii[row - window], b = radii[row], c = radii[row + window];
    if (!(a > 0 && b > 0 && c > 0)) return 0;
    const double height = double(window) * step;
    return std::abs(std::atan2(b - a, height) - std::atan2(c - b, height));
}

/// True if the value at `row` is the largest within `window` rows, the first of equal ones.
template <class Value>
bool is_peak(std::size_t count, std::size_t row, std::size_t window, const Value& value) {
    for (std::size_t k = row > window ? row - window : 0; k <= std::min(count - 1, row + window); ++k)
        if (value(k) > value(row) || (value(k) == value(row) && k < row)) return false;
    return true;
}

}  // namespace

std::vector<Line> horizontal_lines(const WallGrid& grid) {
    const std::size_t n = grid.rows(), window = std::max<std::size_t>(2, n / 40);
    std::vector<double> radii(n, 0);
    double largest = 0;
    for (std::size_t row = 0; row < n; ++row)
        if (const double r = grid.radius(row); r > 0) radii[row] = r, largest = std::max(largest, r);
    std::vector<Line> lines;
    std::vector<double> bends(n, 0), relief(n, 0), noise;
    for (std::size_t row = 0; row < n; ++row) {
        bends[row] = bend(radii, grid.step(), row, window);
        if (radii[row] > 0) relief[row] = radii[row] - smooth_radius(radii, row, 0.02 * double(n));
        if (row >= 2 && row + 2 < n && radii[row - 2] > 0 && radii[row] > 0 && radii[row + 2] > 0)
            noise.push_back(std::abs(radii[row - 2] - 2 * radii[row] + radii[row + 2]));
    }
    if (noise.size() < 8) return lines;
    // The second difference of independent noise has the standard deviation sqrt(6) of the noise.
    const double deviation = 1.4826 * sample_quantile(noise, 0.5) / std::sqrt(6.0);
    const double threshold = std::max(0.006 * largest, 4 * deviation);
    for (std::size_t row = window; row + window < n; ++row) {
        const bool edge = bends[row] > 25 * degree && is_peak(n, row, window, [&](std::size_t k) { return bends[k]; });
        const bool rib = std::abs(relief[row]) > threshold &&
                         is_peak(n, row, window / 2 + 1, [&](std::size_t k) { return std::abs(relief[k]); });
        if (!edge && !rib) continue;
        const double height = grid.height(row);
        const double apart = 1.5 * double(window) * grid.step();
        if (!edge && !lines.empty() && lines.back().type == Line::Type::edge && height - lines.back().height < apart) continue;
        if (edge && !lines.empty() && lines.back().type == Line::Type::rib && height - lines.back().height < apart)
            lines.pop_back();
        lines.push_back({edge ? Line::Type::edge : Line::Type::rib, height, radii[row], 0, 0});
    }
    return lines;
}

}  // namespace ostraka::detail
