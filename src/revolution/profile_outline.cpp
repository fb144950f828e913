#include "revolution/stages.h"

#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace ostraka::detail {

void ProfileImage::add(std::vector<double>& cells, std::size_t row, double from, double to) const {
    const double a = from / step, b = to / step;
    for (auto c = static_cast<std::size_t>(std::max(0.0, a)); c < columns && static_cast<double>(c) < b; ++c) {
        const auto cell_start = static_cast<double>(c);
        cells[row * columns + c] += std::max(0.0, std::min(b, cell_start + 1) - std::max(a, cell_start));
    }
}

void ProfileImage::clear(std::size_t row) {
    present[row] = 0;
    std::fill_n(wall_share.begin() + static_cast<long>(row * columns), columns, 0.0);
}

double ProfileImage::at(long row, long column) const {
    if (column < 0) column = -1 - column;
    if (row < 0 || row >= static_cast<long>(rows) || column >= static_cast<long>(columns)) return 0;
    return wall_share[static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column)];
}

bool ProfileImage::reaches_axis(std::size_t first, std::size_t end) const {
    for (std::size_t row = first; row < end; ++row)
        if (wall_share[row * columns] > 0.5) return true;
    return false;
}

void ProfileImage::bridge(std::vector<std::string>* notes) {
    const auto wall = [&](std::size_t row) {
        std::pair<double, double> bounds{-1, -1};
        for (std::size_t c = 0; c < columns; ++c)
            if (wall_share[row * columns + c] > 0.5) {
                if (bounds.first < 0) bounds.first = static_cast<double>(c) * step;
                bounds.second = static_cast<double>(c + 1) * step;
            }
        return bounds;
    };
    std::size_t last = rows;
    for (std::size_t row = 0; row < rows; ++row) {
        if (!(present[row] > 0) || wall(row).first < 0) continue;
        if (last < rows && row > last + 1) {
            const auto a = wall(last), b = wall(row);
            for (std::size_t between = last + 1; between < row; ++between) {
                const double t = static_cast<double>(between - last) / static_cast<double>(row - last);
                std::fill_n(wall_share.begin() + static_cast<long>(between * columns), columns, 0.0);
                add(wall_share, between, (1 - t) * a.first + t * b.first, (1 - t) * a.second + t * b.second);
            }
            if (notes != nullptr)
                notes->push_back(fmt::format("no wall from height {} to {}: bridged by a straight line",
                                             digits(static_cast<double>(last + 1) * step, 4),
                                             digits(static_cast<double>(row) * step, 4)));
        }
        last = row;
    }
}

void ProfileImage::smooth(double deviation) {
    if (!(deviation > 0)) return;
    const long half_width = std::lround(std::ceil(3 * deviation));
    std::vector<double> kernel;
    double sum = 0;
    for (long k = -half_width; k <= half_width; ++k) {
        kernel.push_back(std::exp(-0.5 * static_cast<double>(k * k) / (deviation * deviation)));
        sum += kernel.back();
    }
    for (const bool along_rows : {true, false}) {
        std::vector<double> result(wall_share.size(), 0);
        for (std::size_t row = 0; row < rows; ++row)
            for (std::size_t c = 0; c < columns; ++c)
                for (long k = -half_width; k <= half_width; ++k)
                    result[row * columns + c] +=
                        kernel[static_cast<std::size_t>(k + half_width)] / sum *
                        at(static_cast<long>(row) + (along_rows ? 0 : k), static_cast<long>(c) + (along_rows ? k : 0));
        wall_share = std::move(result);
    }
}

namespace {

/// The longest part of a loop at positive radii, with its ends on the axis; the whole loop if it does not meet the axis.
Outline right_of_axis(const std::vector<Vector2d>& loop) {
    const std::size_t n = loop.size();
    Outline result;
    for (std::size_t i = 0; i < n; ++i) {
        const Vector2d &a = loop[i], &b = loop[(i + 1) % n];
        if (!(a.x() < 0 && b.x() >= 0)) continue;
        std::vector<Vector2d> part;
        const double t = a.x() / (a.x() - b.x());
        part.emplace_back(0, (1 - t) * a.y() + t * b.y());
        std::size_t k = i + 1;
        for (; k < i + n && loop[k % n].x() >= 0; ++k)
            if (loop[k % n].x() > 0) part.push_back(loop[k % n]);
        const Vector2d &c = loop[(k - 1) % n], &d = loop[k % n];
        const double u = c.x() - d.x() > 0 ? c.x() / (c.x() - d.x()) : 0;
        part.emplace_back(0, (1 - u) * c.y() + u * d.y());
        if (part.size() > result.points.size()) result.points = std::move(part);
    }
    if (!result.points.empty()) return result;
    result.closed = true;
    result.points = loop;
    return result;
}

}  // namespace

Outline ProfileImage::outline() const {
    // The full cross-section, both sides of the axis. Nodes are cell centres; a crossing lies on the edge from a node to the
    // next one to the right (0) or above (1). Segments lead from crossing to crossing, with the wall on the left.
    using Crossing = std::array<long, 3>;
    const long low = -static_cast<long>(columns) - 1, right = static_cast<long>(columns) + 1, top = static_cast<long>(rows) + 1;
    std::map<Crossing, Crossing> next;
    const auto in = [&](long row, long column) { return at(row, column) > 0.5; };
    for (long row = -1; row < top; ++row)
        for (long column = low; column < right; ++column) {
            // Corners and sides of the square, counter-clockwise.
            const bool corner[4] = {in(row, column), in(row, column + 1), in(row + 1, column + 1), in(row + 1, column)};
            const Crossing side[4] = {{row, column, 0}, {row, column + 1, 1}, {row + 1, column, 0}, {row, column, 1}};
            for (int k = 0; k < 4; ++k) {
                // In counter-clockwise order, the curve enters the square where the wall ends and leaves it where the next wall
                // begins.
                if (!(corner[k] && !corner[(k + 1) % 4])) continue;
                int j = (k + 1) % 4;
                while (!(!corner[j] && corner[(j + 1) % 4])) j = (j + 1) % 4;
                next[side[k]] = side[j];
            }
        }
    const auto place = [&](const Crossing& c) {
        const double a = at(c[0], c[1]), b = c[2] == 0 ? at(c[0], c[1] + 1) : at(c[0] + 1, c[1]), t = (0.5 - a) / (b - a);
        return Vector2d(step * (static_cast<double>(c[1]) + 0.5 + (c[2] == 0 ? t : 0)),
                        step * (static_cast<double>(c[0]) + 0.5 + (c[2] == 1 ? t : 0)));
    };
    Outline result;
    double maximum = 0;
    while (!next.empty()) {
        std::vector<Vector2d> loop;
        const Crossing first = next.begin()->first;
        for (Crossing current = first;;) {
            const auto entry = next.find(current);
            if (entry == next.end()) break;
            loop.push_back(place(current));
            current = entry->second;
            next.erase(entry);
            if (current == first) break;
        }
        double area = 0, radius = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vector2d &a = loop[i], &b = loop[(i + 1) % loop.size()];
            area += 0.5 * (a.x() * b.y() - a.y() * b.x());
            radius += a.x() / static_cast<double>(loop.size());
        }
        // Holes have the opposite orientation; of two mirrored pieces the one at positive radii is used.
        Outline piece = right_of_axis(loop);
        if (piece.closed ? radius < 0 : area <= 0) continue;
        if (piece.closed) area *= 2;
        if (area > maximum) maximum = area, result = std::move(piece);
    }
    return result;
}

std::vector<Vector2d> resampled(const std::vector<Vector2d>& line, bool closed, int count) {
    std::vector<double> along{0};
    const std::size_t pieces = closed ? line.size() : line.size() - 1;
    for (std::size_t i = 0; i < pieces; ++i) along.push_back(along.back() + (line[(i + 1) % line.size()] - line[i]).norm());
    std::vector<Vector2d> result;
    std::size_t i = 0;
    for (int k = 0; k < count; ++k) {
        const double s = along.back() * k / (closed ? count : count - 1);
        while (i + 1 < pieces && along[i + 1] < s) ++i;
        const double length = along[i + 1] - along[i], t = length > 0 ? std::min(1.0, (s - along[i]) / length) : 0;
        result.push_back((1 - t) * line[i] + t * line[(i + 1) % line.size()]);
    }
    return result;
}

}  // namespace ostraka::detail
