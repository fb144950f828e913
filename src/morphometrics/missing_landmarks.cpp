#include "ostraka/morphometrics/missing_landmarks.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/morphometrics/thin_plate.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

using Eigen::MatrixXd;

namespace {

/// Landmarks that a specimen has, and that it lacks.
struct Split {
    std::vector<std::size_t> present, absent;
};
Split split_of(const Landmarks& configuration) {
    Split split;
    for (std::size_t k = 0; k < static_cast<std::size_t>(configuration.rows()); ++k)
        (is_missing(configuration, k) ? split.absent : split.present).push_back(k);
    return split;
}

/// Coefficients of a least-squares prediction from `count` principal components.
struct Prediction {
    Eigen::RowVectorXd mean_x, mean_y;
    MatrixXd map;  ///< from deviations of x to deviations of y

    Prediction(const MatrixXd& x, const MatrixXd& y, Eigen::Index count)
        : mean_x(x.colwise().mean()), mean_y(y.colwise().mean()) {
        const MatrixXd dx = x.rowwise() - mean_x, dy = y.rowwise() - mean_y;
        const SvdX svd(dx);
        map = MatrixXd::Zero(x.cols(), y.cols());
        const double floor = 1e-10 * (svd.singularValues().size() > 0 ? svd.singularValues()[0] : 0);
        for (Eigen::Index c = 0; c < std::min<Eigen::Index>(count, svd.singularValues().size()); ++c)
            if (svd.singularValues()[c] > floor)
                map += svd.matrixV().col(c) * (svd.matrixU().col(c).transpose() * dy) / svd.singularValues()[c];
    }
    [[nodiscard]] Eigen::RowVectorXd operator()(const Eigen::RowVectorXd& x) const { return mean_y + (x - mean_x) * map; }
};

/// The number of principal components with the least leave-one-out error of the prediction of y from x.
Eigen::Index best_count(const MatrixXd& x, const MatrixXd& y) {
    const Eigen::Index n = x.rows(), most = std::min<Eigen::Index>({n - 2, x.cols(), 15});
    std::vector<double> errors(static_cast<std::size_t>(most) + 1, 0);
    parallel_for(errors.size(), 1, [&](std::size_t count) {
        for (Eigen::Index left_out = 0; left_out < n; ++left_out) {
            MatrixXd others_x(n - 1, x.cols()), others_y(n - 1, y.cols());
            for (Eigen::Index i = 0, row = 0; i < n; ++i) {
                if (i == left_out) continue;
                others_x.row(row) = x.row(i);
                others_y.row(row++) = y.row(i);
            }
            const Prediction prediction(others_x, others_y, static_cast<Eigen::Index>(count));
            errors[count] += (prediction(x.row(left_out)) - y.row(left_out)).squaredNorm();
        }
    });
    return std::min_element(errors.begin(), errors.end()) - errors.begin();
}

class Completion {
public:
    Completion(const ShapeSample& sample, MissingMethod method, const LandmarkPairs& pairs)
        : sample_(sample), method_(method), pairs_(pairs), options_(sample.procrustes_options()) {
        for (const Landmarks& configuration : sample.configurations)
            if (is_complete(configuration)) complete_.push_back(configuration);
        if (method == MissingMethod::mirror && pairs.pairs.empty())
            fail_input("missing landmarks", "there are no pairs of landmarks to mirror",
                       "give --pairs, name landmarks 'left ...' and 'right ...', or use --missing tps");
    }

    CompletedSample complete() {
        CompletedSample result;
        result.sample = sample_;
        for (std::size_t k = 0; k < sample_.landmarks.size(); ++k) result.kept_landmarks.push_back(k);
        for (std::size_t s = 0; s < sample_.specimens.size(); ++s) {
            const Split split = split_of(sample_.configurations[s]);
            if (split.absent.empty()) continue;
            const std::size_t needed = sample_.dimension == 2 ? 3 : 4;
            if (split.present.size() < needed)
                fail_input(sample_.specimens[s],
                           fmt::format("has {} landmarks; '{}' cannot be estimated", split.present.size(),
                                       sample_.landmarks[split.absent.front()]),
                           "leave the specimen out, or use --missing leave-out");
            Landmarks& x = result.sample.configurations[s];
            std::vector<std::size_t> rest = split.absent;
            if (method_ == MissingMethod::mirror) rest = mirror(s, split, x, result.missing);
            if (rest.empty()) continue;
            const bool regress = method_ == MissingMethod::regression;
            const Landmarks estimate = regress ? by_regression(s, split) : by_spline(s, split);
            for (const std::size_t k : rest) {
                x.row(static_cast<Eigen::Index>(k)) = estimate.row(static_cast<Eigen::Index>(k));
                result.missing.push_back({s, k, regress ? "regression" : "tps"});
            }
        }
        std::stable_sort(result.missing.begin(), result.missing.end(), [](const auto& a, const auto& b) {
            return std::pair(a.specimen, a.landmark) < std::pair(b.specimen, b.landmark);
        });
        return result;
    }

private:
    void need_complete(std::size_t count, std::size_t specimen) const {
        if (complete_.size() >= count) return;
        fail_input(
            sample_.specimens[specimen],
            fmt::format("lacks landmarks, and only {} of {} specimens are complete", complete_.size(), sample_.specimens.size()),
            fmt::format("at least {} are needed; use --missing leave-out", count));
    }

    /// Fills in the mirrored counterparts; returns the landmarks whose counterparts are missing as well, or that lie on the plane
    /// of symmetry.
    std::vector<std::size_t> mirror(std::size_t specimen, const Split& split, Landmarks& x,
                                    std::vector<MissingLandmark>& missing) const {
        const Landmarks& own = sample_.configurations[specimen];
        const Landmarks mirrored = relabelled_mirror(own, pairs_);
        std::vector<std::size_t> common, rest;
        for (const std::size_t k : split.present)
            if (!is_missing(mirrored, k)) common.push_back(k);
        if (common.size() < 3) return split.absent;
        const SimilarityMap map = procrustes(rows_of(mirrored, common), rows_of(own, common), options_);
        const Landmarks placed = map.apply(mirrored);
        for (const std::size_t k : split.absent) {
            if (is_missing(mirrored, k)) {
                rest.push_back(k);
                continue;
            }
            x.row(static_cast<Eigen::Index>(k)) = placed.row(static_cast<Eigen::Index>(k));
            missing.push_back({specimen, k, "mirror"});
        }
        return rest;
    }

    Landmarks by_spline(std::size_t specimen, const Split& split) {
        need_complete(1, specimen);
        if (mean_.rows() == 0) mean_ = generalised_procrustes(complete_, options_).mean;
        const Landmarks& own = sample_.configurations[specimen];
        const ThinPlateSpline spline(rows_of(mean_, split.present), rows_of(own, split.present), sample_.dimension);
        return spline(mean_);
    }

    Landmarks by_regression(std::size_t specimen, const Split& split) const {
        need_complete(4, specimen);
        // All specimens in the frame of the landmarks that this specimen has.
        std::vector<Landmarks> parts;
        for (const Landmarks& configuration : complete_) parts.push_back(rows_of(configuration, split.present));
        parts.push_back(rows_of(sample_.configurations[specimen], split.present));
        const GeneralisedProcrustes frame = generalised_procrustes(parts, options_);
        std::vector<Landmarks> absent;
        for (std::size_t i = 0; i < complete_.size(); ++i)
            absent.push_back(frame.maps[i].apply(rows_of(complete_[i], split.absent)));
        const MatrixXd x = shape_rows(std::vector<Landmarks>(frame.aligned.begin(), frame.aligned.end() - 1)),
                       y = shape_rows(absent);
        const Prediction prediction(x, y, best_count(x, y));
        const Eigen::RowVectorXd predicted = prediction(shape_rows({frame.aligned.back()}));
        const SimilarityMap& map = frame.maps.back();
        Landmarks result = sample_.configurations[specimen];
        for (std::size_t k = 0; k < split.absent.size(); ++k) {
            const Eigen::Vector3d aligned = predicted.segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
            result.row(static_cast<Eigen::Index>(split.absent[k])) =
                (map.rotation.transpose() * (aligned - map.translation) / map.scale).transpose();
        }
        return result;
    }

    const ShapeSample& sample_;
    MissingMethod method_;
    const LandmarkPairs& pairs_;
    ProcrustesOptions options_;
    std::vector<Landmarks> complete_;
    Landmarks mean_;
};

CompletedSample left_out(const ShapeSample& sample) {
    CompletedSample result;
    std::vector<bool> lacking(sample.landmarks.size(), false);
    for (std::size_t s = 0; s < sample.specimens.size(); ++s)
        for (std::size_t k = 0; k < sample.landmarks.size(); ++k)
            if (is_missing(sample.configurations[s], k)) {
                lacking[k] = true;
                result.missing.push_back({s, k, "left out"});
            }
    result.sample.dimension = sample.dimension;
    result.sample.specimens = sample.specimens;
    for (std::size_t k = 0; k < sample.landmarks.size(); ++k)
        if (!lacking[k]) {
            result.kept_landmarks.push_back(k);
            result.sample.landmarks.push_back(sample.landmarks[k]);
        }
    if (result.kept_landmarks.size() < 3)
        fail_input("landmarks", fmt::format("the objects have {} landmarks in common", result.kept_landmarks.size()),
                   "at least three are needed; use --missing tps to estimate missing landmarks");
    for (const Landmarks& configuration : sample.configurations)
        result.sample.configurations.push_back(rows_of(configuration, result.kept_landmarks));
    return result;
}

}  // namespace

CompletedSample complete_landmarks(const ShapeSample& sample, MissingMethod method, const LandmarkPairs& pairs) {
    if (method == MissingMethod::leave_out) return left_out(sample);
    return Completion(sample, method, pairs).complete();
}

}  // namespace ostraka
