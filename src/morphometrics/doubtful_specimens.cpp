#include "ostraka/morphometrics/doubtful_specimens.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ostraka {

namespace {

constexpr std::size_t min_specimens = 5, candidates_kept = 20;
constexpr double whiskers = 1.5, times_median = 1.3;  ///< limits of outliers
constexpr double unusual = 4;                         ///< a landmark this many times its usual distance from the mean is unusual
constexpr double nearer = 0.5;                        ///< a mirror image closer than this share counts

double norm_after_fit(const Landmarks& x, const Landmarks& mean, const ProcrustesOptions& options) {
    return std::sqrt(procrustes(x, mean, options).sum_of_squares);
}

/// ShapeReference of the undoubted specimens.
struct ShapeReference {
    std::vector<bool> core;          ///< for each specimen, whether it is no outlier
    Landmarks mean;                  ///< mean of the core, size 1
    std::vector<Landmarks> aligned;  ///< each specimen fitted to the mean
    std::vector<Landmarks> others;   ///< for each specimen, the mean of the core without it, size 1
    std::vector<double> distances;   ///< from `others`
    double limit = 0;                ///< distances above are outliers
};

double limit_of(const std::vector<double>& distances) {
    const double low = sample_quantile(distances, 0.25), middle = sample_quantile(distances, 0.5),
                 high = sample_quantile(distances, 0.75);
    return std::max(high + whiskers * (high - low), times_median * middle);
}

void update(ShapeReference& reference, const ShapeSample& sample, const ProcrustesOptions& options) {
    const std::size_t n = sample.configurations.size();
    std::vector<Landmarks> core;
    for (std::size_t i = 0; i < n; ++i)
        if (reference.core[i]) core.push_back(sample.configurations[i]);
    reference.mean = generalised_procrustes(core, options).mean;
    const double weight = static_cast<double>(core.size());
    parallel_for(n, 8, [&](std::size_t i) {
        const Landmarks& x = sample.configurations[i];
        reference.aligned[i] = procrustes(x, reference.mean, options).apply(x);
        Landmarks mean = reference.mean;
        if (reference.core[i]) mean = weight * reference.mean - reference.aligned[i];
        mean.rowwise() -= mean.colwise().mean().eval();
        reference.others[i] = mean / mean.norm();
        reference.distances[i] = norm_after_fit(x, reference.others[i], options);
    });
    reference.limit = limit_of(reference.distances);
}

ShapeReference reference_of(const ShapeSample& sample, const ProcrustesOptions& options) {
    const std::size_t n = sample.configurations.size();
    ShapeReference reference;
    reference.core.assign(n, true);
    reference.aligned.resize(n);
    reference.others.resize(n);
    reference.distances.resize(n);
    for (int round = 0; round < 10; ++round) {
        update(reference, sample, options);
        std::vector<bool> core(n);
        for (std::size_t i = 0; i < n; ++i) core[i] = reference.distances[i] <= reference.limit;
        if (core == reference.core || std::count(core.begin(), core.end(), true) < static_cast<std::ptrdiff_t>(min_specimens))
            break;
        reference.core = core;
    }
    return reference;
}

/// Distance of each landmark of each specimen from the mean of the others that is usual: the upper quartile over the core.
std::vector<double> usual_distances(const ShapeReference& reference) {
    std::vector<double> usual;
    for (Eigen::Index k = 0; k < reference.mean.rows(); ++k) {
        std::vector<double> distances;
        for (std::size_t i = 0; i < reference.aligned.size(); ++i)
            if (reference.core[i]) distances.push_back((reference.aligned[i].row(k) - reference.others[i].row(k)).norm());
        usual.push_back(sample_quantile(distances, 0.75));
    }
    // A landmark without any variation would make every deviation unusual.
    const double floor = 0.2 * sample_quantile(usual, 0.5);
    for (double& distance : usual) distance = std::max({distance, floor, 1e-9});
    return usual;
}

/// Tests which single error explains a specimen.
class Explanation {
public:
    Explanation(const ShapeReference& reference, const std::vector<double>& usual, const ProcrustesOptions& options)
        : reference_(reference), usual_(usual), options_(options) {}

    [[nodiscard]] std::optional<Doubt> of(const Landmarks& x, std::size_t specimen) const {
        Doubt doubt;
        doubt.specimen = specimen;
        doubt.distance = doubt.corrected = reference_.distances[specimen];
        doubt.limit = reference_.limit;
        const Landmarks& mean = reference_.others[specimen];
        Landmarks mirror = x;
        mirror.col(0) *= -1;
        const double mirrored = norm_after_fit(mirror, mean, options_);
        if (mirrored < nearer * doubt.distance && doubt.distance > 1e-3) {
            doubt.cause = DoubtCause::mirrored;
            doubt.corrected = mirrored;
            return doubt;
        }
        if (exchange(x, mean, doubt)) return doubt;
        if (doubt.distance <= doubt.limit) return {};
        displace(x, mean, doubt);
        return doubt;
    }

private:
    /// Landmarks of a fitted configuration that are unusually far from the mean.
    [[nodiscard]] bool is_unusual(const Landmarks& fitted, const Landmarks& mean, Eigen::Index k) const {
        return (fitted.row(k) - mean.row(k)).norm() > unusual * usual_[static_cast<std::size_t>(k)];
    }

    [[nodiscard]] bool exchange(const Landmarks& x, const Landmarks& mean, Doubt& doubt) const {
        const Landmarks fitted = procrustes(x, mean, options_).apply(x);
        const Eigen::Index k = x.rows();
        // The decrease of the sum of squares by each exchange without a new fit.
        struct Candidate {
            double gain;
            Eigen::Index a, b;
        };
        std::vector<Candidate> candidates;
        for (Eigen::Index a = 0; a < k; ++a)
            for (Eigen::Index b = a + 1; b < k; ++b) {
                const double gain = 2 * (fitted.row(b) - fitted.row(a)).dot(mean.row(a) - mean.row(b));
                if (gain > 0) candidates.push_back({gain, a, b});
            }
        const std::size_t kept = std::min(candidates.size(), candidates_kept);
        std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(kept), candidates.end(),
                          [](const Candidate& p, const Candidate& q) {
                              return p.gain != q.gain ? p.gain > q.gain : std::pair(p.a, p.b) < std::pair(q.a, q.b);
                          });
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < kept; ++c) {
            const auto [gain, a, b] = candidates[c];
            Landmarks exchanged = x;
            exchanged.row(a).swap(exchanged.row(b));
            const SimilarityMap map = procrustes(exchanged, mean, options_);
            const double distance = std::sqrt(map.sum_of_squares);
            if (distance >= best || distance >= doubt.distance) continue;
            const Landmarks corrected = map.apply(exchanged);
            Landmarks before = corrected;  // as recorded, in the pose of the corrected configuration
            before.row(a).swap(before.row(b));
            const auto squares = [&](const Landmarks& y) {
                return (y.row(a) - mean.row(a)).squaredNorm() + (y.row(b) - mean.row(b)).squaredNorm();
            };
            if (!is_unusual(before, mean, a) || !is_unusual(before, mean, b) || is_unusual(corrected, mean, a) ||
                is_unusual(corrected, mean, b) || squares(corrected) > nearer * squares(before))
                continue;
            best = distance;
            doubt.cause = DoubtCause::exchanged;
            doubt.landmarks = {static_cast<std::size_t>(a), static_cast<std::size_t>(b)};
            doubt.corrected = distance;
        }
        return doubt.cause == DoubtCause::exchanged;
    }

    /// Whether the specimen is usual without one landmark.
    void displace(const Landmarks& x, const Landmarks& mean, Doubt& doubt) const {
        const auto k = static_cast<std::size_t>(x.rows());
        if (k < 5) return;
        double best = doubt.limit;
        for (std::size_t out = 0; out < k; ++out) {
            std::vector<std::size_t> rest;
            for (std::size_t j = 0; j < k; ++j)
                if (j != out) rest.push_back(j);
            const Landmarks target = rows_of(mean, rest);
            const SimilarityMap map = procrustes(rows_of(x, rest), target, options_);
            const double distance = std::sqrt(map.sum_of_squares);
            if (distance >= best || !is_unusual(map.apply(x), mean, static_cast<Eigen::Index>(out))) continue;
            best = distance;
            doubt.cause = DoubtCause::displaced;
            doubt.landmarks = {out};
            doubt.corrected = distance;
        }
    }

    const ShapeReference& reference_;
    const std::vector<double>& usual_;
    const ProcrustesOptions& options_;
};

}  // namespace

std::vector<Doubt> doubtful_specimens(const ShapeSample& sample) {
    const std::size_t n = sample.configurations.size();
    if (n < min_specimens) return {};
    const ProcrustesOptions options = sample.procrustes_options();
    const ShapeReference reference = reference_of(sample, options);
    const std::vector<double> usual = usual_distances(reference);
    const Explanation explanation(reference, usual, options);
    std::vector<std::optional<Doubt>> doubts(n);
    parallel_for(n, 1, [&](std::size_t i) { doubts[i] = explanation.of(sample.configurations[i], i); });
    std::vector<Doubt> result;
    for (auto& doubt : doubts)
        if (doubt) result.push_back(*std::move(doubt));
    return result;
}

}  // namespace ostraka
