#include "ostraka/registration/procrustes.h"
#include "ostraka/algebra/dense.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

constexpr int max_iterations = 10000;

Eigen::RowVector3d centroid_of(const Landmarks& landmarks) {
    // Relative to the first landmark, to avoid cancellation far from the origin.
    return landmarks.row(0) + (landmarks.rowwise() - landmarks.row(0)).colwise().mean();
}

void check(const Landmarks& landmarks, Eigen::Index count, const std::string& where) {
    if (landmarks.rows() != count)
        fail_input(where, fmt::format("it has {} landmarks, but the first has {}", landmarks.rows(), count),
                   "give the same landmarks everywhere, in the same order");
    if (count < 3) fail_input(where, fmt::format("there are {} landmarks", count), "give at least three");
    if (!landmarks.allFinite())
        fail_input(where, "a coordinate is not a finite number",
                   "give a finite coordinate, or leave that landmark out of all specimens");
    if (!(centroid_size(landmarks) > 0)) fail_input(where, "all landmarks coincide", "leave it out");
}

/// The rotation R that maximises trace(R A) for A = from^T to of centred configurations (rows), and the trace.
struct BestRotation {
    Eigen::Matrix3d rotation;
    double trace = 0;
};
BestRotation best_planar_rotation(const Landmarks& from, const Landmarks& to, bool reflection) {
    const Eigen::Matrix2d a = from.leftCols<2>().transpose() * to.leftCols<2>();
    // Of all rotations R(t): trace(R A) = c cos t + s sin t; of all reflections likewise with y negated.
    const double c = a(0, 0) + a(1, 1), s = a(0, 1) - a(1, 0), mirrored_c = a(0, 0) - a(1, 1), mirrored_s = a(0, 1) + a(1, 0);
    BestRotation best;
    best.rotation.setIdentity();
    const double z = from.col(2).dot(to.col(2)), turn = std::hypot(c, s), mirrored_turn = std::hypot(mirrored_c, mirrored_s);
    best.trace = turn + z;
    if (reflection && mirrored_turn > turn) {
        best.trace = mirrored_turn + z;
        const double cosine = mirrored_c / mirrored_turn, sine = mirrored_s / mirrored_turn;
        best.rotation.topLeftCorner<2, 2>() << cosine, sine, sine, -cosine;
    } else if (turn > 0) {
        best.rotation.topLeftCorner<2, 2>() << c / turn, -s / turn, s / turn, c / turn;
    }
    return best;
}
BestRotation best_rotation(const Landmarks& from, const Landmarks& to, const ProcrustesOptions& options) {
    if (options.planar) return best_planar_rotation(from, to, options.reflection);
    const Svd3 svd(from.transpose() * to);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if (!options.reflection && (svd.matrixU().determinant() < 0) != (svd.matrixV().determinant() < 0)) signs[2] = -1;
    return {svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose(), svd.singularValues().dot(signs)};
}

}  // namespace

double centroid_size(const Landmarks& landmarks) {
    if (landmarks.rows() == 0) return 0;
    return (landmarks.rowwise() - centroid_of(landmarks)).stableNorm();
}

Landmarks SimilarityMap::apply(const Landmarks& landmarks) const {
    return (scale * landmarks * rotation.transpose()).rowwise() + translation.transpose();
}

SimilarityMap procrustes(const Landmarks& from, const Landmarks& to, const ProcrustesOptions& options) {
    check(from, from.rows(), "the landmarks to be moved");
    check(to, from.rows(), "the target landmarks");
    const Eigen::RowVector3d a = centroid_of(from), b = centroid_of(to);
    // Normalised to size 1, so that products neither overflow nor underflow.
    const double from_size = centroid_size(from), to_size = centroid_size(to);
    const Landmarks x = (from.rowwise() - a) / from_size, y = (to.rowwise() - b) / to_size;
    const BestRotation best = best_rotation(x, y, options);
    SimilarityMap map;
    map.rotation = best.rotation;
    map.scale = options.scaling ? best.trace * to_size / from_size : 1;
    map.translation = (b - map.scale * (a * map.rotation.transpose())).transpose();
    map.sum_of_squares = ((map.scale * from_size) * x * map.rotation.transpose() - to_size * y).squaredNorm();
    return map;
}

GeneralisedProcrustes generalised_procrustes(const std::vector<Landmarks>& configurations, const ProcrustesOptions& options) {
    if (configurations.empty()) fail_input("landmarks", "there is no configuration", "give at least one");
    const std::size_t n = configurations.size();
    GeneralisedProcrustes result;
    std::vector<Eigen::RowVector3d> centres;
    std::vector<Landmarks> centred;
    double unit = 0;
    for (std::size_t i = 0; i < n; ++i) {
        check(configurations[i], configurations[0].rows(), "configuration " + std::to_string(i + 1));
        result.centroid_sizes.push_back(centroid_size(configurations[i]));
        unit = std::max(unit, result.centroid_sizes.back());
    }
    // In units of the largest size, or each of size 1.
    for (std::size_t i = 0; i < n; ++i) {
        centres.push_back(centroid_of(configurations[i]));
        centred.push_back((configurations[i].rowwise() - centres.back()) / (options.scaling ? result.centroid_sizes[i] : unit));
    }
    const double back = options.scaling ? 1 : unit;
    result.aligned = centred;
    std::vector<Eigen::Matrix3d> rotations(n, Eigen::Matrix3d::Identity());
    result.mean = centred.front();
    double before = std::numeric_limits<double>::infinity(), total_squares = 0;
    for (const Landmarks& x : centred) total_squares += x.squaredNorm();
    while (result.iterations < max_iterations && !result.converged) {
        check_cancelled();
        ++result.iterations;
        parallel_for(n, [&](std::size_t i) {
            rotations[i] = best_rotation(centred[i], result.mean, options).rotation;
            result.aligned[i] = centred[i] * rotations[i].transpose();
        });
        Landmarks mean = Landmarks::Zero(result.mean.rows(), 3);
        for (const Landmarks& x : result.aligned) mean += x / static_cast<double>(n);
        double sum = 0;
        for (const Landmarks& x : result.aligned) sum += (x - mean).squaredNorm();
        // Near convergence the mean moves by the square root of the remaining decrease of the sum.
        const double moved = (mean - result.mean).squaredNorm() * static_cast<double>(n);
        result.converged = std::abs(before - sum) <= 1e-15 * total_squares && (n == 1 || moved <= 1e-26 * total_squares);
        before = sum;
        result.mean = mean;
    }
    if (options.scaling && result.mean.norm() > 0) result.mean /= result.mean.norm();
    // In the orientation of the first configuration.
    const Eigen::Matrix3d back_rotation = rotations.front().transpose();
    result.mean = back * (result.mean * back_rotation.transpose());
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Matrix3d rotation = back_rotation * rotations[i];
        result.aligned[i] = back * (centred[i] * rotation.transpose());
        SimilarityMap map;
        map.scale = options.scaling ? 1 / result.centroid_sizes[i] : 1;
        map.rotation = rotation;
        map.translation = -map.scale * (rotation * centres[i].transpose());
        map.sum_of_squares = (result.aligned[i] - result.mean).squaredNorm();
        result.sum_of_squares += map.sum_of_squares;
        result.maps.push_back(map);
    }
    return result;
}

bool are_planar(const std::vector<Landmarks>& configurations) {
    return !configurations.empty() && std::all_of(configurations.begin(), configurations.end(), [](const Landmarks& x) {
        return x.rows() > 0 && (x.col(2).array() == 0).all();
    });
}

Eigen::MatrixXd shape_rows(const std::vector<Landmarks>& configurations) {
    if (configurations.empty()) return {};
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(configurations.size()), 3 * configurations[0].rows());
    for (std::size_t i = 0; i < configurations.size(); ++i)
        for (Eigen::Index k = 0; k < configurations[i].rows(); ++k)
            rows.block<1, 3>(static_cast<Eigen::Index>(i), 3 * k) = configurations[i].row(k);
    return rows;
}

void ProcrustesOptions::declare_options(OptionList& list) {
    list("scaling", scaling, "scale all objects to the same size", Anything{});
    list("reflection", reflection, "treat mirror images as the same shape", Anything{});
}

}  // namespace ostraka
