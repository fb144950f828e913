// Exact rasterisation of triangles in texels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace ostraka::texture {

/// A point in units of 1/256 texel.
struct GridPoint {
    std::int64_t x, y;
};
using GridTriangle = std::array<GridPoint, 3>;

inline constexpr std::int64_t grid_unit = 256;  ///< grid units per texel
/// Largest absolute value of a coordinate in texels, so that products fit into 64 bits.
inline constexpr double max_grid_texel = 0x1p21;

inline GridPoint grid_point(double x, double y) {
    return {std::llround(x * static_cast<double>(grid_unit)), std::llround(y * static_cast<double>(grid_unit))};
}

/// Twice the signed area, in squared grid units.
inline std::int64_t grid_area(const GridTriangle& t) {
    return (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[1].y - t[0].y) * (t[2].x - t[0].x);
}

/// Division rounded down, for a positive divisor.
inline std::int64_t floor_ratio(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// Columns [begin, end) of a row.
struct ColumnSpan {
    std::int64_t begin, end;
};

/// Columns of the texels of a row whose centres lie in the triangle, which must be counter-clockwise (grid_area > 0). A centre on
/// an edge belongs to one of the two triangles on the edge, so that triangles which share edges cover each centre once.
inline ColumnSpan row_span(const GridTriangle& t, std::int64_t row, std::int64_t width) {
    const std::int64_t half = grid_unit / 2, y = row * grid_unit + half;
    ColumnSpan span{0, width};
    for (std::size_t k = 0; k < 3; ++k) {
        const GridPoint &a = t[k], &b = t[(k + 1) % 3];
        const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
        // Inside where constant - dy * x >= 0.
        const std::int64_t constant = dx * (y - a.y) + dy * a.x - (dy > 0 || (dy == 0 && dx > 0) ? 0 : 1);
        if (dy > 0) {
            span.end = std::min(span.end, floor_ratio(floor_ratio(constant, dy) - half, grid_unit) + 1);
        } else if (dy < 0) {
            const std::int64_t least = -floor_ratio(constant, -dy);
            span.begin = std::max(span.begin, -floor_ratio(half - least, grid_unit));
        } else if (constant < 0) {
            return {0, 0};
        }
    }
    return span;
}

/// Calls action(row, begin, end) for the columns [begin, end) of each row in [first_row, beyond_row) whose texel centres lie in a
/// triangle of either orientation. Triangles without area cover nothing.
template <class Action>
void for_each_span(GridTriangle t, std::int64_t width, std::int64_t first_row, std::int64_t beyond_row, Action&& action) {
    const std::int64_t area = grid_area(t);
    if (area == 0) return;
    if (area < 0) std::swap(t[1], t[2]);
    const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
    first_row = std::max(first_row, floor_ratio(low, grid_unit));
    beyond_row = std::min(beyond_row, floor_ratio(high, grid_unit) + 1);
    for (std::int64_t row = first_row; row < beyond_row; ++row) {
        const ColumnSpan span = row_span(t, row, width);
        if (span.begin < span.end) action(row, span.begin, span.end);
    }
}

}  // namespace ostraka::texture
