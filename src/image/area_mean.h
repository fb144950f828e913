// Means over rectangles of pixels: each cell of a coarse grid covers, exactly and without gaps, a part of the fine grid.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace ostraka::images {

/// The pixels that cell number `cell` of `coarse` cells covers of `fine` pixels (coarse <= fine), in units in which a pixel has
/// the width `coarse` and a cell the width `fine`.
struct Coverage {
    Coverage(int cell, int coarse, int fine)
        : begin(static_cast<int>(std::int64_t{cell} * fine / coarse)),
          end(static_cast<int>((std::int64_t{cell} * fine + fine + coarse - 1) / coarse)),
          lower_(std::int64_t{cell} * fine),
          upper_(lower_ + fine),
          step_(coarse) {}
    /// Width of the overlap of the cell with a pixel.
    [[nodiscard]] double of(int pixel) const {
        const std::int64_t left = pixel * step_;
        return static_cast<double>(std::min(left + step_, upper_) - std::max(left, lower_));
    }
    int begin, end;  ///< pixels with an overlap

private:
    std::int64_t lower_, upper_, step_;
};

/// Sums of `read(column, row)`, an array of numbers, over the covered pixels, weighted by the area of the overlap. The weights
/// add up to the width of both grids multiplied by their height: divide by `columns` x `rows` of the fine grid.
template <std::size_t count, class Read>
std::array<double, count> area_sum(const Coverage& columns, const Coverage& rows, const Read& read) {
    std::array<double, count> sum{};
    for (int row = rows.begin; row < rows.end; ++row)
        for (int column = columns.begin; column < columns.end; ++column) {
            const double weight = columns.of(column) * rows.of(row);
            const auto values = read(column, row);
            for (std::size_t k = 0; k < count; ++k) sum[k] += weight * static_cast<double>(values[k]);
        }
    return sum;
}

}  // namespace ostraka::images
