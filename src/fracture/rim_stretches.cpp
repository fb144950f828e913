#include "rim_stretches.h"

#include "ostraka/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Vector3d;

namespace {

/// A loop resampled at equal distances.
struct EvenLoop {
    std::vector<Vector3d> places, sides;
    std::vector<Facet> facets;
    bool closed = true;

    /// Number of possible start positions of a stretch of `count` samples.
    [[nodiscard]] std::size_t starts(std::size_t count) const {
        if (places.size() < count) return 0;
        return closed ? places.size() : places.size() - count + 1;
    }
};

EvenLoop evenly(const RimLoop& loop, double spacing) {
    EvenLoop result;
    result.closed = loop.closed;
    const std::size_t n = loop.places.size(), segments = loop.closed ? n : n - 1;
    double length = 0;
    std::vector<double> along{0};
    for (std::size_t k = 0; k < segments; ++k) along.push_back(length += (loop.places[(k + 1) % n] - loop.places[k]).norm());
    const auto count = static_cast<std::size_t>(length / spacing);
    if (count < 2) return result;
    const double step = length / static_cast<double>(count);
    std::size_t k = 0;
    for (std::size_t i = 0; i < (loop.closed ? count : count + 1); ++i) {
        const double at = std::min(length, step * static_cast<double>(i));
        while (k + 1 < segments && along[k + 1] < at) ++k;
        const double whole = along[k + 1] - along[k], t = whole > 0 ? (at - along[k]) / whole : 0;
        const std::size_t next = (k + 1) % n;
        result.places.push_back((1 - t) * loop.places[k] + t * loop.places[next]);
        result.sides.push_back(((1 - t) * loop.sides[k] + t * loop.sides[next]).normalized());
        result.facets.push_back(loop.facets[t < 0.5 ? k : next]);
    }
    return result;
}

class StretchSearch {
public:
    StretchSearch(const std::vector<RimLoop>& first, const std::vector<RimLoop>& second, double shortest, double tolerance)
        : tolerance_(tolerance), spacing_(shortest / static_cast<double>(few)) {
        for (const RimLoop& loop : first) a_.push_back(evenly(loop, spacing_));
        for (const RimLoop& loop : second) b_.push_back(evenly(loop, spacing_));
    }

    std::vector<StretchFit> run(std::size_t count) {
        std::vector<StretchFit> found;
        for (const std::size_t length : {8, 11, 16, 23, 32, 45, 64})
            for (std::size_t i = 0; i < a_.size(); ++i)
                for (std::size_t j = 0; j < b_.size(); ++j) compare(i, j, length, found);
        std::stable_sort(found.begin(), found.end(), [](const StretchFit& x, const StretchFit& y) { return x.told > y.told; });
        if (found.size() > count) found.resize(count);
        return found;
    }

private:
    static constexpr std::size_t few = 8;
    static constexpr double widest = 1.5, noise = 0.2, straight = 0.5;  // in tolerances

    void compare(std::size_t i, std::size_t j, std::size_t count, std::vector<StretchFit>& found) const {
        const EvenLoop &a = a_[i], &b = b_[j];
        const std::size_t rows = a.starts(count), columns = b.starts(count), n = a.places.size(), m = b.places.size();
        if (rows == 0 || columns == 0) return;
        // Chord lengths are invariant under rigid motion.
        const std::size_t half = count / 2, last = count - 1;
        std::vector<std::vector<StretchFit>> of_row(rows);
        parallel_for(
            rows,
            [&](std::size_t r) {
                const auto at = [&](std::size_t t) -> const Vector3d& { return a.places[(r + t) % n]; };
                const double whole = (at(last) - at(0)).norm(), left = (at(half) - at(0)).norm(),
                             right = (at(last) - at(half)).norm();
                double bend = 0;
                const Vector3d chord = whole > 0 ? Vector3d((at(last) - at(0)) / whole) : Vector3d(Vector3d::UnitX());
                for (std::size_t t = 0; t < count; ++t) {
                    const Vector3d off = at(t) - at(0);
                    bend += (off - off.dot(chord) * chord).squaredNorm() / static_cast<double>(count);
                }
                bend = std::sqrt(bend);
                if (bend < straight * tolerance_) return;  // too straight: it matches any straight stretch
                std::vector<Vector3d> from(2 * count), to(2 * count);
                std::vector<double> weights(2 * count, 1);
                const double lever = 0.3 * spacing_ * static_cast<double>(count);
                for (std::size_t t = count; t < 2 * count; ++t) weights[t] = 0.3;
                for (std::size_t c = 0; c < columns; ++c) {
                    // The second rim is traversed backwards from the end of its stretch.
                    const auto other = [&](std::size_t t) -> const Vector3d& { return b.places[(c + last - t) % m]; };
                    if (a.facets[(r + half) % n] != b.facets[(c + half) % m]) continue;
                    const double slack = 2 * tolerance_;
                    if (std::abs((other(last) - other(0)).norm() - whole) > slack ||
                        std::abs((other(half) - other(0)).norm() - left) > slack ||
                        std::abs((other(last) - other(half)).norm() - right) > slack)
                        continue;
                    for (std::size_t t = 0; t < count; ++t) {
                        from[t] = other(t);
                        to[t] = at(t);
                        from[count + t] = other(t) + lever * b.sides[(c + last - t) % m];
                        to[count + t] = at(t) + lever * a.sides[(r + t) % n];
                    }
                    StretchFit fit;
                    fit.pose = fit_motion(from, to, weights);
                    double squares = 0;
                    for (std::size_t t = 0; t < count; ++t)
                        squares += (fit.pose(from[t]) - to[t]).squaredNorm() / static_cast<double>(count);
                    fit.deviation = std::sqrt(squares);
                    if (fit.deviation > widest * tolerance_) continue;
                    fit.length = spacing_ * static_cast<double>(count);
                    fit.bend = bend;
                    // Information of the match: each position is known to the deviation within a range of the bend.
                    fit.told =
                        static_cast<double>(count) * std::log((noise * tolerance_ + bend) / (noise * tolerance_ + fit.deviation));
                    if (fit.told > 0) of_row[r].push_back(fit);
                }
                // Keeps the best ten of a row: neighbouring rows give the same matches.
                std::stable_sort(of_row[r].begin(), of_row[r].end(),
                                 [](const auto& x, const auto& y) { return x.told > y.told; });
                if (of_row[r].size() > 10) of_row[r].resize(10);
            },
            4);
        for (const auto& row : of_row) found.insert(found.end(), row.begin(), row.end());
    }

    double tolerance_, spacing_;
    std::vector<EvenLoop> a_, b_;
};

}  // namespace

std::vector<StretchFit> matching_stretches(const std::vector<RimLoop>& first, const std::vector<RimLoop>& second, double shortest,
                                           double tolerance, std::size_t count) {
    return StretchSearch(first, second, shortest, tolerance).run(count);
}

}  // namespace ostraka
