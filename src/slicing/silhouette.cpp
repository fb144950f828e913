// Triangles are rasterised into a fine mask, whose coverage is traced by marching squares.
#include "ostraka/slicing/silhouette.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>

namespace ostraka {

namespace {

constexpr int fine = 4;  ///< samples per cell and direction

/// Coverage mask, with samples `step` apart.
class Mask {
public:
    Mask(const Vector2d& low, const Vector2d& high, int cells) {
        const Vector2d size = high - low;
        step_ = std::max(size.maxCoeff(), std::numeric_limits<double>::min()) / (cells * fine);
        columns_ = (static_cast<int>(std::ceil(size.x() / step_ / fine)) + 2) * fine;
        rows_ = (static_cast<int>(std::ceil(size.y() / step_ / fine)) + 2) * fine;
        low_ = low - Vector2d(fine * step_, fine * step_);
        covered_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), false);
    }

    void add(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
        const Vector2d corner[3] = {(a - low_) / step_, (b - low_) / step_, (c - low_) / step_};
        const double bottom = std::min({corner[0].y(), corner[1].y(), corner[2].y()});
        const double top = std::max({corner[0].y(), corner[1].y(), corner[2].y()});
        // Samples lie at the centres of their cells.
        for (int row = std::max(0, static_cast<int>(std::ceil(bottom - 0.5))); row <= std::min(rows_ - 1.0, top - 0.5); ++row) {
            const double y = row + 0.5;
            double left = std::numeric_limits<double>::infinity(), right = -left;
            for (int k = 0; k < 3; ++k) {
                const Vector2d &p = corner[k], &q = corner[(k + 1) % 3];
                if (std::min(p.y(), q.y()) > y || std::max(p.y(), q.y()) < y) continue;
                const double x = p.y() == q.y() ? p.x() : p.x() + (y - p.y()) / (q.y() - p.y()) * (q.x() - p.x());
                left = std::min(left, x), right = std::max(right, x);
                if (p.y() == q.y()) left = std::min(left, q.x()), right = std::max(right, q.x());
            }
            // Slightly enlarged, so that no gap appears between neighbours.
            const int from = std::max(0, static_cast<int>(std::ceil(left - 0.5 - 1e-9)));
            for (int column = from; column <= std::min(columns_ - 1.0, right - 0.5 + 1e-9); ++column)
                covered_[at(column, row)] = true;
        }
    }

    [[nodiscard]] int cell_columns() const { return columns_ / fine; }
    [[nodiscard]] int cell_rows() const { return rows_ / fine; }
    /// Fraction of the samples of a cell that are covered.
    [[nodiscard]] double coverage(int column, int row) const {
        int count = 0;
        for (int i = 0; i < fine; ++i)
            for (int j = 0; j < fine; ++j) count += covered_[at(column * fine + i, row * fine + j)] ? 1 : 0;
        return double(count) / (fine * fine);
    }
    [[nodiscard]] Vector2d place(const Vector2d& cell) const { return low_ + step_ * fine * cell; }
    [[nodiscard]] double cell() const { return step_ * fine; }

private:
    [[nodiscard]] std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    Vector2d low_;
    double step_ = 1;
    int columns_ = 0, rows_ = 0;
    std::vector<bool> covered_;
};

/// Start and end sides of the curves in a square, in pairs (0 below, 1 right, 2 above, 3 left), indexed by the covered corners
/// (1, 2, 4, 8, counter-clockwise from the lower left). Covered corners are connected.
constexpr std::array<std::string_view, 16> curve_pieces{"",   "03", "10",   "13", "21", "0123", "20", "23",
                                                        "32", "02", "3012", "12", "31", "01",   "30", ""};

/// Level curves of coverage one half, with the covered side to the left.
std::vector<std::vector<Vector2d>> trace(const Mask& mask) {
    const int columns = mask.cell_columns(), rows = mask.cell_rows();
    std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto value = [&](int c, int r) -> double& {
        return values[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)];
    };
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) value(c, r) = mask.coverage(c, r);
    // Keys of the edges of the grid of cell centres: even to the right of (c, r), odd above.
    const auto right = [&](int c, int r) { return 2 * (static_cast<std::int64_t>(r) * columns + c); };
    const auto above = [&](int c, int r) { return right(c, r) + 1; };
    std::unordered_map<std::int64_t, std::int64_t> next;
    std::vector<std::int64_t> starts;
    for (int r = 0; r + 1 < rows; ++r)
        for (int c = 0; c + 1 < columns; ++c) {
            const auto covered = [&](int column, int row) { return value(column, row) >= 0.5 ? 1U : 0U; };
            const std::string_view piece =
                curve_pieces[covered(c, r) | covered(c + 1, r) << 1 | covered(c + 1, r + 1) << 2 | covered(c, r + 1) << 3];
            const std::int64_t sides[] = {right(c, r), above(c + 1, r), right(c, r + 1), above(c, r)};
            for (std::size_t k = 0; k < piece.size(); k += 2) {
                starts.push_back(sides[piece[k] - '0']);
                next[starts.back()] = sides[piece[k + 1] - '0'];
            }
        }
    const auto point_on = [&](std::int64_t key) {
        const auto r = static_cast<int>(key / 2 / columns), c = static_cast<int>(key / 2 % columns);
        const double value_from = value(c, r), value_to = key % 2 == 0 ? value(c + 1, r) : value(c, r + 1),
                     t = (0.5 - value_from) / (value_to - value_from);
        return mask.place(Vector2d(c + 0.5 + (key % 2 == 0 ? t : 0), r + 0.5 + (key % 2 == 0 ? 0 : t)));
    };
    std::vector<std::vector<Vector2d>> curves;
    for (const auto start : starts) {
        auto segment = next.find(start);
        if (segment == next.end()) continue;
        std::vector<Vector2d> curve;
        while (segment != next.end()) {
            curve.push_back(point_on(segment->first));
            const auto end = segment->second;
            next.erase(segment);
            segment = next.find(end);
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// Keeps points farther than `tolerance` from the line between kept points (Douglas and Peucker 1973).
std::vector<Vector2d> thinned(const std::vector<Vector2d>& curve, double tolerance) {
    std::vector<bool> keep(curve.size(), false);
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < curve.size(); ++i)
        if ((curve[i] - curve[0]).norm() > (curve[farthest] - curve[0]).norm()) farthest = i;
    keep[0] = keep[farthest] = true;
    const std::size_t n = curve.size();
    std::vector<std::pair<std::size_t, std::size_t>> stack{{0, farthest}, {farthest, n}};
    while (!stack.empty()) {
        const auto [from, to] = stack.back();
        stack.pop_back();
        const Vector2d& a = curve[from];
        const Vector2d along = curve[to % n] - a;
        double maximum = tolerance;
        std::size_t worst = from;
        for (std::size_t i = from + 1; i < to; ++i) {
            const Vector2d q = curve[i] - a;
            const double t = along.squaredNorm() > 0 ? std::clamp(q.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
            if (const double d = (q - t * along).norm(); d > maximum) maximum = d, worst = i;
        }
        if (worst == from) continue;
        keep[worst] = true;
        stack.emplace_back(from, worst), stack.emplace_back(worst, to);
    }
    std::vector<Vector2d> simplified;
    for (std::size_t i = 0; i < n; ++i)
        if (keep[i]) simplified.push_back(curve[i]);
    return simplified;
}

}  // namespace

std::vector<std::vector<Vector2d>> silhouette(const Mesh& mesh, const SliceFrame& frame, int cells,
                                              const std::vector<Index>& faces) {
    if (cells < 8 || cells > 4000) fail_usage(fmt::format("the number of cells of the silhouette is {}", cells), "use 8 to 4000");
    std::vector<std::array<Vector2d, 3>> triangles;
    const auto add = [&](Face f) {
        const auto [a, b, c] = corners(mesh, f);
        triangles.push_back({frame.place(mesh.point(a)), frame.place(mesh.point(b)), frame.place(mesh.point(c))});
    };
    if (faces.empty())
        for (const Face f : mesh.faces()) add(f);
    for (const Index f : faces) add(Face(f));
    if (triangles.empty()) fail_input("mesh", "has no faces to draw", "choose another mesh");
    Vector2d low = triangles[0][0], high = low;
    for (const auto& triangle : triangles)
        for (const auto& p : triangle) low = low.cwiseMin(p), high = high.cwiseMax(p);
    Mask mask(low, high, cells);
    for (const auto& [a, b, c] : triangles) mask.add(a, b, c);
    std::vector<std::vector<Vector2d>> curves;
    for (const auto& curve : trace(mask))
        if (curve.size() > 3) curves.push_back(thinned(curve, mask.cell() / 4));
    return curves;
}

}  // namespace ostraka
