#include "ostraka/morphometrics/sliding.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/morphometrics/thin_plate.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::VectorXd;

namespace {

constexpr double still = 1e-6;         ///< movement of the mean at which sliding ends
constexpr std::size_t neighbours = 5;  ///< landmarks to which a tangent plane is fitted

void check(const ShapeSample& sample, const SemiLandmarks& semi) {
    const std::size_t k = sample.landmarks.size();
    std::set<std::size_t> sliding;
    const auto add = [&](std::size_t landmark) {
        if (!sliding.insert(landmark).second)
            fail_input("sliders", fmt::format("landmark {} slides twice", landmark + 1), "list each semi-landmark once");
    };
    const auto exists = [&](std::size_t landmark) {
        if (landmark >= k)
            fail_input("sliders", fmt::format("there is no landmark {}", landmark + 1),
                       fmt::format("the specimens have {} landmarks", k));
    };
    for (const Slider& slider : semi.curves) {
        for (const std::size_t landmark : {slider.before, slider.slides, slider.after}) exists(landmark);
        if (slider.before == slider.slides || slider.after == slider.slides || slider.before == slider.after)
            fail_input("sliders", fmt::format("the neighbours of landmark {} are not two other landmarks", slider.slides + 1),
                       "give three different landmarks in each row: before, slide, after");
        add(slider.slides);
    }
    for (const std::size_t landmark : semi.surface) exists(landmark), add(landmark);
    if (k < sliding.size() + 3)
        fail_input("sliders", fmt::format("{} of {} landmarks slide", sliding.size(), k), "at least three must not slide");
    for (std::size_t s = 0; s < sample.specimens.size(); ++s)
        if (!is_complete(sample.configurations[s]))
            fail_input(sample.specimens[s], "lacks landmarks", "estimate missing landmarks first");
}

/// Unit tangents of the semi-landmarks of one configuration: one direction on a curve, two on a surface.
struct Tangent {
    std::size_t landmark;
    RowVector3d direction;
};

RowVector3d unit_or_zero(const RowVector3d& v) {
    const double length = v.norm();
    return length > 0 ? RowVector3d(v / length) : RowVector3d::Zero();
}

/// The landmarks nearest to each surface semi-landmark in the mean, itself included.
std::vector<std::vector<std::size_t>> nearest_landmarks(const Landmarks& mean, const std::vector<std::size_t>& surface) {
    std::vector<std::vector<std::size_t>> result;
    for (const std::size_t landmark : surface) {
        std::vector<std::size_t> order(static_cast<std::size_t>(mean.rows()));
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const auto distance = [&](std::size_t i) {
                return (mean.row(static_cast<Eigen::Index>(i)) - mean.row(static_cast<Eigen::Index>(landmark))).squaredNorm();
            };
            return distance(a) < distance(b);
        });
        order.resize(std::min(order.size(), neighbours + 1));
        result.push_back(std::move(order));
    }
    return result;
}

RowVector3d fitted_normal(const Landmarks& x, const std::vector<std::size_t>& near) {
    const Landmarks points = rows_of(x, near);
    const Landmarks centred = points.rowwise() - points.colwise().mean();
    return SymmetricEigen3(centred.transpose() * centred).eigenvectors().col(0).transpose();
}

class Slide {
public:
    Slide(const ShapeSample& sample, const SemiLandmarks& semi, const SlidingOptions& options)
        : sample_(sample), semi_(semi), options_(options), fit_(sample.procrustes_options()) {}

    SlidSample run() {
        SlidSample result;
        result.sample = sample_;
        std::vector<Landmarks>& x = result.sample.configurations;
        GeneralisedProcrustes aligned = generalised_procrustes(x, fit_);
        result.energy_before = energy(aligned);
        while (result.iterations < options_.iterations && !result.converged) {
            check_cancelled();
            ++result.iterations;
            const MatrixXd bending = options_.criterion == SlidingCriterion::bending_energy
                                         ? bending_energy_matrix(aligned.mean, sample_.dimension)
                                         : MatrixXd();
            const auto near =
                semi_.surface_of ? std::vector<std::vector<std::size_t>>() : nearest_landmarks(aligned.mean, semi_.surface);
            parallel_for(x.size(), 1, [&](std::size_t s) { slide(s, aligned, bending, near, x[s]); });
            GeneralisedProcrustes next = generalised_procrustes(x, fit_);
            result.converged = std::sqrt(procrustes(next.mean, aligned.mean, fit_).sum_of_squares) < still;
            aligned = std::move(next);
        }
        result.energy_after = energy(aligned);
        double squares = 0;
        for (std::size_t s = 0; s < x.size(); ++s)
            squares += (x[s] - sample_.configurations[s]).squaredNorm() / std::pow(aligned.centroid_sizes[s], 2);
        const auto moved = static_cast<double>((semi_.curves.size() + semi_.surface.size()) * x.size());
        result.moved = std::sqrt(squares / moved);
        return result;
    }

private:
    [[nodiscard]] double energy(const GeneralisedProcrustes& aligned) const {
        const MatrixXd bending = bending_energy_matrix(aligned.mean, sample_.dimension);
        double sum = 0;
        for (const Landmarks& x : aligned.aligned) sum += (x.transpose() * bending * x).trace();
        return sum;
    }

    /// Tangents of a configuration in the frame of its specimen, turned into the aligned frame.
    [[nodiscard]] std::vector<Tangent> tangents(std::size_t s, const Landmarks& own, const SimilarityMap& map,
                                                const std::vector<std::vector<std::size_t>>& near) const {
        std::vector<Tangent> result;
        const auto row = [&](std::size_t i) -> RowVector3d { return own.row(static_cast<Eigen::Index>(i)); };
        const auto add = [&](std::size_t landmark, const RowVector3d& direction) {
            if (direction.squaredNorm() > 0) result.push_back({landmark, direction * map.rotation.transpose()});
        };
        for (const Slider& slider : semi_.curves) add(slider.slides, unit_or_zero(row(slider.after) - row(slider.before)));
        for (std::size_t i = 0; i < semi_.surface.size(); ++i) {
            const std::size_t landmark = semi_.surface[i];
            const RowVector3d normal = semi_.surface_of ? semi_.surface_of(s, row(landmark)).normal : fitted_normal(own, near[i]);
            Eigen::Index smallest = 0;
            normal.cwiseAbs().minCoeff(&smallest);
            const RowVector3d first = unit_or_zero(normal.cross(RowVector3d::Unit(smallest)));
            add(landmark, first);
            add(landmark, unit_or_zero(normal.cross(first)));
        }
        return result;
    }

    void slide(std::size_t s, const GeneralisedProcrustes& aligned, const MatrixXd& bending,
               const std::vector<std::vector<std::size_t>>& near, Landmarks& own) const {
        const SimilarityMap& map = aligned.maps[s];
        const std::vector<Tangent> directions = tangents(s, own, map, near);
        const Landmarks& y = aligned.aligned[s];
        const auto count = static_cast<Eigen::Index>(directions.size());
        VectorXd steps = VectorXd::Zero(count);
        if (options_.criterion == SlidingCriterion::procrustes_distance) {
            for (Eigen::Index i = 0; i < count; ++i) {
                const auto& [landmark, direction] = directions[static_cast<std::size_t>(i)];
                const auto k = static_cast<Eigen::Index>(landmark);
                steps[i] = direction.dot(aligned.mean.row(k) - y.row(k));
            }
        } else {
            // U^T L U and U^T L Y, where L has the bending matrix once for each axis.
            MatrixXd A(count, count);
            VectorXd b(count);
            const Landmarks by = bending * y;
            for (Eigen::Index i = 0; i < count; ++i) {
                const auto& [landmark, direction] = directions[static_cast<std::size_t>(i)];
                b[i] = -direction.dot(by.row(static_cast<Eigen::Index>(landmark)));
                for (Eigen::Index j = 0; j < count; ++j) {
                    const auto& [other, other_direction] = directions[static_cast<std::size_t>(j)];
                    A(i, j) = bending(static_cast<Eigen::Index>(landmark), static_cast<Eigen::Index>(other)) *
                              direction.dot(other_direction);
                }
            }
            // Bending is indifferent to some slides where the curve is straight: then the shortest one is taken.
            if (count > 0) {
                const Cholesky factor(A);
                steps = factor.succeeded() && factor.rcond() > 1e-11 ? factor.solve(b) : solve_least_squares(A, b, 1e-11);
            }
        }
        Landmarks moved = y;
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto& [landmark, direction] = directions[static_cast<std::size_t>(i)];
            moved.row(static_cast<Eigen::Index>(landmark)) += steps[i] * direction;
        }
        put_back(s, moved, map, own);
    }

    /// Maps the semi-landmarks back to the frame of the specimen, and onto its surface.
    void put_back(std::size_t s, const Landmarks& moved, const SimilarityMap& map, Landmarks& own) const {
        const auto back = [&](std::size_t landmark) -> RowVector3d {
            const Eigen::Vector3d aligned = moved.row(static_cast<Eigen::Index>(landmark)).transpose() - map.translation;
            return (map.rotation.transpose() * aligned / map.scale).transpose();
        };
        for (const Slider& slider : semi_.curves) own.row(static_cast<Eigen::Index>(slider.slides)) = back(slider.slides);
        for (const std::size_t landmark : semi_.surface) {
            const RowVector3d place = back(landmark);
            own.row(static_cast<Eigen::Index>(landmark)) = semi_.surface_of ? semi_.surface_of(s, place).point : place;
        }
    }

    const ShapeSample& sample_;
    const SemiLandmarks& semi_;
    const SlidingOptions& options_;
    ProcrustesOptions fit_;
};

}  // namespace

SlidSample slide_semilandmarks(const ShapeSample& sample, const SemiLandmarks& semi, const SlidingOptions& options) {
    check_options(options, "sliding");
    check(sample, semi);
    if (semi.empty()) return {sample, 0, true, 0, 0, 0, {}};
    return Slide(sample, semi, options).run();
}

void SlidingOptions::declare_options(OptionList& list) {
    list("slide-by", criterion, "what sliding semi-landmarks minimise: bending energy, or Procrustes distance from the mean",
         Choices{"bending-energy", "procrustes-distance"});
    list("slide-iterations", iterations, "maximum number of alternations of sliding and superimposition", Range{1, 1000});
}

}  // namespace ostraka
