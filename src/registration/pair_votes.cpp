#include "registration/pair_votes.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

namespace {

constexpr int angles = 12;                    ///< bins from 0 to pi
constexpr int rotation_bins = 36;             ///< bins of the rotation about a normal
constexpr std::size_t max_entries = 1000000;  ///< max table entries visited per reference point of the part

/// A frame whose third axis is the normal.
Matrix3d frame(const Vector3d& normal) {
    const Vector3d other = std::abs(normal.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY();
    Matrix3d m;
    m.col(0) = other.cross(normal).normalized();
    m.col(1) = normal.cross(m.col(0));
    m.col(2) = normal;
    return m;
}

/// Table of angle bins by cosine: bin bounds are exact to the step of the table.
class AngleBins {
public:
    AngleBins() {
        for (int k = 0; k < size; ++k)
            bin_[static_cast<std::size_t>(k)] =
                static_cast<std::int8_t>(std::min(angles - 1.0, std::acos(2 * (k + 0.5) / size - 1) / pi * angles));
    }
    int operator()(double cosine) const {
        return bin_[static_cast<std::size_t>(std::clamp(static_cast<int>((cosine + 1) * half_size), 0, size - 1))];
    }

private:
    static constexpr int size = 4096, half_size = size / 2;
    std::array<std::int8_t, size> bin_{};
};

const AngleBins angle_bin;

}  // namespace

long PairTable::key(const Vector3d& p, const Vector3d& n, const Vector3d& q, const Vector3d& m) const {
    const Vector3d d = q - p;
    const double length = d.norm();
    if (!(length > 0.5 * step_ && length < max_distance_)) return -1;
    const int bin = std::min(distances_ - 1, static_cast<int>(length / step_));
    return ((static_cast<long>(bin) * angles + angle_bin(n.dot(d) / length)) * angles + angle_bin(m.dot(d) / length)) * angles +
           angle_bin(n.dot(m));
}

PairTable::PairTable(SurfacePoints points, double max_distance, double step)
    : points_(std::move(points)), max_distance_(max_distance), step_(step) {
    if (points_.size() > 4096)
        fail_usage(fmt::format("pairs of {} points are too many", points_.size()), "use at most 4096 points");
    if (!(max_distance > 0 && step > 0)) fail_usage("pairs of points need lengths above 0");
    distances_ = static_cast<int>(std::min(1000.0, std::ceil(max_distance / step)));
    const std::size_t n = points_.size();
    std::vector<std::int32_t> keys(n * n, -1);
    parallel_for(n, 16, [&](std::size_t i) {
        for (std::size_t j = 0; j < n; ++j)
            if (j != i)
                keys[i * n + j] =
                    static_cast<std::int32_t>(key(points_.places[i], points_.normals[i], points_.places[j], points_.normals[j]));
    });
    starts_.assign(static_cast<std::size_t>(distances_) * angles * angles * angles + 1, 0);
    for (const std::int32_t k : keys)
        if (k >= 0) ++starts_[static_cast<std::size_t>(k) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    entries_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::size_t i = 0; i < n; ++i) {
        const Matrix3d axes = frame(points_.normals[i]);
        for (std::size_t j = 0; j < n; ++j) {
            const std::int32_t k = keys[i * n + j];
            if (k < 0) continue;
            const Vector3d d = points_.places[j] - points_.places[i];
            const double turn = std::atan2(axes.col(1).dot(d), axes.col(0).dot(d));
            entries_[next[static_cast<std::size_t>(k)]++] = {
                static_cast<std::uint16_t>(i), static_cast<std::int16_t>(std::clamp(turn / pi * 32768, -32768.0, 32767.0))};
        }
    }
}

std::vector<VotedMotion> PairTable::vote(const SurfacePoints& part, int references, int partners, int kept,
                                         std::uint64_t seed) const {
    const std::size_t n = part.size(), point_count = points_.size();
    if (n < 2 || point_count == 0) return {};
    const std::size_t count = std::min(n, static_cast<std::size_t>(references));
    std::vector<std::vector<VotedMotion>> reference_motions(count);
    parallel_for(count, 1, [&](std::size_t r) {
        const std::size_t i = r * n / count;
        Random random(seed, i);
        std::vector<std::size_t> others(n);
        for (std::size_t k = 0; k < n; ++k) others[k] = k;
        if (n > static_cast<std::size_t>(partners)) {
            random.shuffle(others);
            others.resize(static_cast<std::size_t>(partners));
        }
        const Matrix3d axes = frame(part.normals[i]);
        std::vector<float> votes(point_count * rotation_bins, 0.0F);
        // Rare features first, within the budget: on a sphere or a plane all pairs have few distinct features.
        struct Kind {
            std::size_t begin, end, partner;
        };
        std::vector<Kind> kinds;
        for (const std::size_t j : others) {
            const long k = j == i ? -1 : key(part.places[i], part.normals[i], part.places[j], part.normals[j]);
            if (k < 0) continue;
            const std::size_t begin = starts_[static_cast<std::size_t>(k)], end = starts_[static_cast<std::size_t>(k) + 1];
            if (begin < end) kinds.push_back({begin, end, j});
        }
        std::stable_sort(kinds.begin(), kinds.end(),
                         [](const Kind& a, const Kind& b) { return a.end - a.begin < b.end - b.begin; });
        std::size_t visited = 0;
        for (const auto& [begin, end, j] : kinds) {
            if (visited > max_entries) break;
            visited += end - begin;
            const Vector3d d = part.places[j] - part.places[i];
            const double part_bin = std::atan2(axes.col(1).dot(d), axes.col(0).dot(d)) / (2 * pi) * rotation_bins;
            const auto weight = static_cast<float>(1 / std::sqrt(static_cast<double>(end - begin)));
            for (std::size_t e = begin; e < end; ++e) {
                const double turn = entries_[e].angle * (rotation_bins / 65536.0) - part_bin + rotation_bins;
                int bin = static_cast<int>(turn + 0.5);  // NOLINT(bugprone-incorrect-roundings): never negative
                if (bin >= rotation_bins) bin -= rotation_bins;
                if (bin >= rotation_bins) bin -= rotation_bins;
                votes[entries_[e].reference * static_cast<std::size_t>(rotation_bins) + static_cast<std::size_t>(bin)] += weight;
            }
        }
        // The best rotation for each point of the whole (with the votes of adjacent bins), then the best points.
        struct ReferencePeak {
            float votes;
            std::uint32_t reference;
            double turn;
        };
        std::vector<ReferencePeak> best;
        best.reserve(point_count);
        for (std::size_t p = 0; p < point_count; ++p) {
            const float* v = &votes[p * rotation_bins];
            float maximum = 0;
            int best_bin = 0;
            for (int b = 0; b < rotation_bins; ++b) {
                const float sum = v[b] + 0.5F * (v[(b + 1) % rotation_bins] + v[(b + rotation_bins - 1) % rotation_bins]);
                if (sum > maximum) maximum = sum, best_bin = b;
            }
            const float before = v[(best_bin + rotation_bins - 1) % rotation_bins], after = v[(best_bin + 1) % rotation_bins];
            const double shift =
                v[best_bin] + before + after > 0 ? double(after - before) / double(v[best_bin] + before + after) : 0;
            if (maximum > 0) best.push_back({maximum, static_cast<std::uint32_t>(p), best_bin + shift});
        }
        const auto better = [](const ReferencePeak& a, const ReferencePeak& b) {
            return a.votes != b.votes ? a.votes > b.votes : a.reference < b.reference;
        };
        const std::size_t kept_count = std::min(best.size(), static_cast<std::size_t>(kept));
        std::partial_sort(best.begin(), best.begin() + static_cast<long>(kept_count), best.end(), better);
        for (std::size_t k = 0; k < kept_count; ++k) {
            const double angle = 2 * pi * best[k].turn / rotation_bins;
            Motion motion;
            motion.rotation = frame(points_.normals[best[k].reference]) *
                              Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix() * axes.transpose();
            motion.translation = points_.places[best[k].reference] - motion.rotation * part.places[i];
            reference_motions[r].push_back({motion, best[k].votes});
        }
    });
    std::vector<VotedMotion> result;
    for (auto& motions : reference_motions) result.insert(result.end(), motions.begin(), motions.end());
    return result;
}

}  // namespace ostraka
