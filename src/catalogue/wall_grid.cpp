#include "catalogue/wall_grid.h"

#include "ostraka/core/angles.h"
#include "ostraka/slicing/slice.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::detail {

namespace {

constexpr double no_distance = std::numeric_limits<double>::quiet_NaN();

std::size_t bin_of(const Vector2d& p) {
    const double turn = std::atan2(p.y(), p.x()) / (2 * pi);
    const auto bin = static_cast<long>(std::floor((turn - std::floor(turn)) * double(WallGrid::bins)));
    return static_cast<std::size_t>(std::clamp(bin, 0L, long{WallGrid::bins} - 1));
}

void keep_largest(double& value, double candidate) {
    if (!(value >= candidate)) value = candidate;
}

/// Enters the points of a segment of a contour; its material is on the left.
void enter(const Vector2d& a, const Vector2d& b, double* outer, double* inner) {
    const Vector2d along = b - a;
    const double length = along.norm();
    if (!(length > 0)) return;
    const double nearest = std::max(1e-9, std::min(a.norm(), b.norm()));
    const auto parts = static_cast<int>(std::clamp(std::ceil(length / nearest * double(WallGrid::bins) / 4), 1.0, 720.0));
    const Vector2d outward(along.y() / length, -along.x() / length);
    for (int k = 0; k < parts; ++k) {
        const Vector2d p = a + (k + 0.5) / parts * along;
        const double radius = p.norm();
        if (!(radius > 0)) continue;
        const double facing = outward.dot(p) / radius;
        constexpr double along_radius = 0.3;
        if (std::abs(facing) < along_radius) continue;
        keep_largest((facing > 0 ? outer : inner)[bin_of(p)], radius);
    }
}

double median_of(std::vector<double>& values) { return values.empty() ? no_distance : upper_median(values); }

}  // namespace

WallGrid::WallGrid(const Mesh& mesh, std::size_t rows) {
    const SliceFrame frame;
    std::tie(low_, high_) = height_range(mesh, frame);
    heights_ = slice_heights(low_, high_, static_cast<int>(rows));
    step_ = (high_ - low_) / double(rows);
    const SliceStack stack = slice_mesh(mesh, frame, heights_);
    outer_.assign(rows * bins, no_distance);
    inner_.assign(rows * bins, no_distance);
    for (std::size_t row = 0; row < rows; ++row)
        for (const Contour& contour : stack.slices[row].contours)
            for (std::size_t i = 0; i < contour.faces.size(); ++i)
                enter(contour.points[i], contour.points[(i + 1) % contour.points.size()], &outer_[row * bins],
                      &inner_[row * bins]);
}

bool WallGrid::wall(std::size_t row, std::size_t bin) const { return outer(row, bin) > 0 || inner(row, bin) > 0; }

double WallGrid::coverage(std::size_t row) const {
    const auto begin = outer_.begin() + static_cast<long>(row * bins);
    return double(std::count_if(begin, begin + bins, [](double r) { return r > 0; })) / double(bins);
}

double WallGrid::hollow(std::size_t row) const {
    const auto begin = inner_.begin() + static_cast<long>(row * bins);
    return double(std::count_if(begin, begin + bins, [](double r) { return r > 0; })) / double(bins);
}

double WallGrid::radius(std::size_t row, const std::vector<bool>& used) const {
    std::vector<double> values;
    for (std::size_t bin = 0; bin < bins; ++bin)
        if (outer(row, bin) > 0 && (used.empty() || used[bin])) values.push_back(outer(row, bin));
    return median_of(values);
}

double WallGrid::inner_radius(std::size_t row) const {
    std::vector<double> values;
    for (std::size_t bin = 0; bin < bins; ++bin)
        if (inner(row, bin) > 0) values.push_back(inner(row, bin));
    return median_of(values);
}

std::vector<long> WallGrid::ends(bool top) const {
    std::vector<long> rows_of_ends(bins, -1);
    for (std::size_t bin = 0; bin < bins; ++bin)
        for (std::size_t k = 0; k < rows() && rows_of_ends[bin] < 0; ++k)
            if (const std::size_t row = top ? rows() - 1 - k : k; wall(row, bin)) rows_of_ends[bin] = static_cast<long>(row);
    return rows_of_ends;
}

std::vector<Vector2d> WallGrid::arc(std::size_t row) const {
    std::vector<Vector2d> points;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const double angle = 2 * pi * (double(bin) + 0.5) / double(bins), r = outer(row, bin);
        if (r > 0) points.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
    return points;
}

AngularRange occupied(const WallGrid& grid) {
    constexpr std::size_t bins = WallGrid::bins;
    std::vector<bool> full(bins, false);
    for (std::size_t bin = 0; bin < bins; ++bin)
        for (std::size_t row = 0; row < grid.rows() && !full[bin]; ++row) full[bin] = grid.wall(row, bin);
    std::size_t widest = 0, after = 0;  // length of the widest gap, and the first bin after it
    for (std::size_t bin = 0; bin < bins; ++bin) {
        if (!full[bin]) continue;
        std::size_t gap = 0;
        while (gap < bins && !full[(bin + bins - 1 - gap) % bins]) ++gap;
        if (gap > widest) widest = gap, after = bin;
    }
    const double width = 2 * pi / double(bins);
    return {double(after) * width, double(bins - widest) * width};
}

}  // namespace ostraka::detail
