#include "fracture/rim_stretches.h"

#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

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
        const double position = std::min(length, step * static_cast<double>(i));
        while (k + 1 < segments && along[k + 1] < position) ++k;
        const double segment_length = along[k + 1] - along[k],
                     t = segment_length > 0 ? (position - along[k]) / segment_length : 0;
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
        : tolerance_(tolerance), spacing_(shortest / static_cast<double>(samples_per_shortest)) {
        for (const RimLoop& loop : first) a_.push_back(evenly(loop, spacing_));
        for (const RimLoop& loop : second) b_.push_back(evenly(loop, spacing_));
    }

    std::vector<StretchFit> run(std::size_t count) {
        std::vector<StretchFit> fits;
        for (const std::size_t length : {8, 11, 16, 23, 32, 45, 64})
            for (std::size_t i = 0; i < a_.size(); ++i)
                for (std::size_t j = 0; j < b_.size(); ++j) compare(i, j, length, fits);
        std::stable_sort(fits.begin(), fits.end(),
                         [](const StretchFit& x, const StretchFit& y) { return x.information > y.information; });
        if (fits.size() > count) fits.resize(count);
        return fits;
    }

private:
    static constexpr std::size_t samples_per_shortest = 8;
    static constexpr double widest = 1.5, noise = 0.2, straight = 0.5;  // in tolerances

    void compare(std::size_t i, std::size_t j, std::size_t count, std::vector<StretchFit>& fits) const {
        const EvenLoop &a = a_[i], &b = b_[j];
        const std::size_t rows = a.starts(count), columns = b.starts(count), n = a.places.size(), m = b.places.size();
        if (rows == 0 || columns == 0) return;
        // Chord lengths are invariant under rigid motion.
        const std::size_t half = count / 2, last = count - 1;
        std::vector<std::vector<StretchFit>> row_fits(rows);
        parallel_for(rows, 4, [&](std::size_t r) {
            const auto place_a = [&](std::size_t t) -> const Vector3d& { return a.places[(r + t) % n]; };
            const double chord_length = (place_a(last) - place_a(0)).norm(), first_chord = (place_a(half) - place_a(0)).norm(),
                         second_chord = (place_a(last) - place_a(half)).norm();
            double bend = 0;
            const Vector3d chord =
                chord_length > 0 ? Vector3d((place_a(last) - place_a(0)) / chord_length) : Vector3d(Vector3d::UnitX());
            for (std::size_t t = 0; t < count; ++t) {
                const Vector3d offset = place_a(t) - place_a(0);
                bend += (offset - offset.dot(chord) * chord).squaredNorm() / static_cast<double>(count);
            }
            bend = std::sqrt(bend);
            if (bend < straight * tolerance_) return;  // too straight: it matches any straight stretch
            std::vector<Vector3d> from(2 * count), to(2 * count);
            std::vector<double> weights(2 * count, 1);
            const double lever = 0.3 * spacing_ * static_cast<double>(count);
            for (std::size_t t = count; t < 2 * count; ++t) weights[t] = 0.3;
            for (std::size_t c = 0; c < columns; ++c) {
                // The second rim is traversed backwards from the end of its stretch.
                const auto place_b = [&](std::size_t t) -> const Vector3d& { return b.places[(c + last - t) % m]; };
                if (a.facets[(r + half) % n] != b.facets[(c + half) % m]) continue;
                const double slack = 2 * tolerance_;
                if (std::abs((place_b(last) - place_b(0)).norm() - chord_length) > slack ||
                    std::abs((place_b(half) - place_b(0)).norm() - first_chord) > slack ||
                    std::abs((place_b(last) - place_b(half)).norm() - second_chord) > slack)
                    continue;
                for (std::size_t t = 0; t < count; ++t) {
                    from[t] = place_b(t);
                    to[t] = place_a(t);
                    from[count + t] = place_b(t) + lever * b.sides[(c + last - t) % m];
                    to[count + t] = place_a(t) + lever * a.sides[(r + t) % n];
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
                fit.information =
                    static_cast<double>(count) * std::log((noise * tolerance_ + bend) / (noise * tolerance_ + fit.deviation));
                if (fit.information > 0) row_fits[r].push_back(fit);
            }
            // Keeps the best ten of a row: neighbouring rows give the same matches.
            std::stable_sort(row_fits[r].begin(), row_fits[r].end(),
                             [](const auto& x, const auto& y) { return x.information > y.information; });
            if (row_fits[r].size() > 10) row_fits[r].resize(10);
        });
        for (const auto& row : row_fits) fits.insert(fits.end(), row.begin(), row.end());
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
