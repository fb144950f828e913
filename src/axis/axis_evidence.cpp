// Evidence of one part on an axis.
#include "ostraka/axis/axis_evidence.h"

#include "axis/revolved_profile.h"

#include "ostraka/algebra/dense.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using namespace detail;

struct AxisEvidenceEvaluator::State {
    Vector3d centroid = Vector3d::Zero();
    double scale = 1, area = 0, tolerance = 0;
    std::vector<RoundSample> samples;
};

namespace {

/// Effective number of independent samples among `count`: the variance of the means over patches of the wall (a bin of heights,
/// as wide as high) is at least that of single samples divided by their number.
double independent(const std::vector<RoundSample>& samples, const AxisGuess& guess, const AxisLine& line,
                   const RevolvedProfile& profile, const std::vector<double>& error, double count) {
    double lowest = 1e300, highest = -1e300;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (profile.bin_of[i] >= 0) lowest = std::min(lowest, profile.height[i]), highest = std::max(highest, profile.height[i]);
    const double side = std::max(1e-9, (highest - lowest) / 20);
    struct Patch {
        double weight = 0, sum = 0, squares = 0;
    };
    std::map<std::pair<int, int>, Patch> patches;
    double total_weight = 0, squares = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double weight = samples[i].weight * profile.robust[i];
        if (profile.bin_of[i] < 0 || !(weight > 0)) continue;
        const Vector3d d = samples[i].p - line.point;
        const double arc_length = std::atan2(guess.w.dot(d), guess.u.dot(d)) * profile.radius[i];
        Patch& patch = patches[{profile.bin_of[i], static_cast<int>(std::floor(arc_length / side))}];
        patch.weight += weight, patch.sum += weight * error[i], patch.squares += weight * weight;
        total_weight += weight, squares += weight * error[i] * error[i];
    }
    if (!(total_weight > 0) || !(squares > 0)) return count;
    const double variance = squares / total_weight;
    double between_patches = 0, expected = 0;
    for (const auto& [key, patch] : patches) {
        between_patches += patch.sum * patch.sum / patch.weight;
        expected += variance * patch.squares / patch.weight;
    }
    return count / std::max(1.0, between_patches / std::max(1e-300, expected));
}

}  // namespace

AxisEvidenceEvaluator::AxisEvidenceEvaluator(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options)
    : state_(std::make_unique<State>()) {
    const AreaMoments moments = part_moments(mesh, faces, options);
    state_->area = moments.area;
    state_->centroid = eigen(moments.centroid);
    state_->scale = part_diagonal(mesh, faces);
    state_->tolerance = options.tolerance;
    state_->samples = take_samples(mesh, faces, options.smoothing, state_->centroid, state_->scale);
}
AxisEvidenceEvaluator::~AxisEvidenceEvaluator() = default;
AxisEvidenceEvaluator::AxisEvidenceEvaluator(AxisEvidenceEvaluator&&) noexcept = default;

bool AxisEvidenceEvaluator::enough() const { return state_->samples.size() >= 12; }
const Vector3d& AxisEvidenceEvaluator::centroid() const { return state_->centroid; }
double AxisEvidenceEvaluator::area() const { return state_->area; }
double AxisEvidenceEvaluator::diagonal() const { return state_->scale; }

AxisEvidence AxisEvidenceEvaluator::at(const AxisGuess& guess) const {
    const double scale = state_->scale;
    AxisEvidence evidence;
    const Vector3d along = guess.direction.normalized();
    evidence.place = guess.point + along * (state_->centroid - guess.point).dot(along);
    if (!enough()) return evidence;
    const auto& samples = state_->samples;
    const AxisLine line{(evidence.place - state_->centroid) / scale, along};
    const RevolvedProfile profile(samples, line);
    const AxisRefinement system(samples, line, profile, guess.u, guess.w);
    // Samples of a floor count by their normals alone.
    constexpr double max_sine = 0.2;
    double total_area = 0, consistent_area = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        total_area += samples[i].weight;
        if (std::abs(sine(samples[i], line)) > max_sine) continue;
        if (profile.bin_of[i] >= 0 && std::abs(profile.error[i]) > state_->tolerance) continue;
        consistent_area += samples[i].weight;
    }
    evidence.round = total_area > 0 ? consistent_area / total_area : 0;
    if (!(system.weight > 0)) return evidence;
    const Eigen::Matrix4d damped = system.H + 1e-9 * system.H.trace() * Eigen::Matrix4d::Identity();
    const Eigen::Vector4d step = -solve_ldlt<4>(damped, system.g);
    std::vector<double> error = profile.error;
    double squares = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        // A large step is unreliable.
        if (step.allFinite() && step.norm() < 0.2) error[i] += system.rows[i].dot(step);
        squares += samples[i].weight * profile.robust[i] * (profile.bin_of[i] >= 0 ? error[i] * error[i] : 0);
    }
    // Faces are chords: no mesh is rounder than this.
    constexpr double min_deviation = 2e-4;
    const double variance = squares / system.weight + min_deviation * min_deviation;
    evidence.residual = std::sqrt(variance) * scale;
    evidence.samples = independent(samples, guess, line, profile, error, system.count);
    const Eigen::Vector4d unit(1 / scale, 1 / scale, 1, 1);
    const double information = evidence.samples / (variance * system.weight);
    evidence.information = information * unit.asDiagonal() * system.H * unit.asDiagonal();
    evidence.gradient = information * unit.asDiagonal() * system.g;
    return evidence;
}

}  // namespace ostraka
