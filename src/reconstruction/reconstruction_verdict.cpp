#include "reconstruction/reconstruction_verdict.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/reconstruction/rigid_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace ostraka {

std::string to_string(ObjectionKind kind) {
    return enum_name(kind, {"placement", "size", "landmarks", "surface", "overlap", "constraint"});
}

std::string to_string(Compatibility compatibility) {
    return enum_name(compatibility, {"compatible", "incompatible", "undecided"});
}

namespace {

/// Sum of squares of the template's landmarks about their mean: the weight of a fragment in the common scale.
double weight_of(const std::vector<LandmarkPair>& pairs, const FragmentPlacement& placement, bool on_fragment) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double count = 0, sum = 0;
    const auto place = [&](const LandmarkPair& pair) { return on_fragment ? pair.on_fragment : pair.on_template; };
    const auto used = [&](std::size_t i) { return i >= placement.landmarks.size() || placement.landmarks[i].used; };
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (used(i)) middle += place(pairs[i]), ++count;
    if (!(count > 0)) return 0;
    middle /= count;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (used(i)) sum += (place(pairs[i]) - middle).squaredNorm();
    return sum;
}

/// The landmarks used, on the template and on the fragment.
std::array<std::vector<Eigen::Vector3d>, 2> used_landmarks(const std::vector<LandmarkPair>& pairs,
                                                           const FragmentPlacement& placement) {
    std::array<std::vector<Eigen::Vector3d>, 2> used;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (i >= placement.landmarks.size() || placement.landmarks[i].used)
            used[0].push_back(pairs[i].on_template), used[1].push_back(pairs[i].on_fragment);
    return used;
}

/// The scale of the template from the used landmarks that move rigidly together.
double rigid_scale_of(const std::vector<LandmarkPair>& pairs, const FragmentPlacement& placement) {
    const auto [from, to] = used_landmarks(pairs, placement);
    return rigid_scale(from, to);
}

/// Per cent by which the larger of two sizes exceeds the smaller.
double per_cent_apart(double a, double b) { return 100 * (std::max(a, b) / std::min(a, b) - 1); }

/// Evaluates the evidence against the fragments of one reconstruction.
class Judge {
public:
    Judge(Reconstruction& result, const std::vector<std::vector<LandmarkPair>>& pairs, const std::vector<int>& placed,
          const ReconstructOptions& options)
        : result_(result), pairs_(pairs), placed_(placed), options_(options) {}

    void judge() {
        if (!result_.placement.any()) {
            result_.undecided = "no fragment could be placed";
            for (std::size_t k = 0; k < pairs_.size(); ++k)
                record_objection(ObjectionKind::placement, static_cast<int>(k), -1, 0, result_.placement.fragments[k].problem);
            return;
        }
        std::size_t placed = 0;
        for (std::size_t k = 0; k < pairs_.size(); ++k) {
            const FragmentPlacement& placement = result_.placement.fragments[k];
            if (!placement.problem.empty()) {
                record_objection(ObjectionKind::placement, static_cast<int>(k), -1, 0, "not placed: " + placement.problem);
                continue;
            }
            ++placed;
            judge_fragment(k);
        }

        for (std::size_t i = 0; i < placed_.size(); ++i) judge_surface(i);
        bool tested = false;
        for (const ConstraintReport& constraint : result_.constraints) {
            if (!constraint.used) continue;
            tested = true;
            judge_constraint(constraint);
        }
        const bool contradicted =
            std::any_of(result_.objections.begin(), result_.objections.end(),
                        [](const Objection& objection) { return objection.kind != ObjectionKind::placement; });
        if (contradicted) {
            result_.verdict = Compatibility::incompatible;
        } else if (placed < pairs_.size()) {
            result_.undecided = "not all fragments could be placed";
        } else if (result_.rotations && std::any_of(result_.rotations->notes.begin(), result_.rotations->notes.end(),
                                                    [](const std::string& note) { return !note.empty(); })) {
            result_.undecided = "the rotations of some fragments about the axis are not decided";
        } else if (!inconclusive_.empty()) {
            result_.undecided = inconclusive_;
        } else if (placed == 1 && !tested) {
            result_.undecided = "there is one fragment and no constraint: nothing can contradict it";
        } else {
            result_.verdict = Compatibility::compatible;
        }
    }

private:
    void record_objection(ObjectionKind kind, int fragment, int constraint, double strain, const std::string& text) {
        result_.strain = std::max(result_.strain, strain);
        if (kind == ObjectionKind::placement || strain > 1)
            result_.objections.push_back({kind, fragment, constraint, strain, text});
    }

    /// Compares a fragment's size with that of the others, and its landmarks with the template's.
    void judge_fragment(std::size_t k) {
        const FragmentPlacement& placement = result_.placement.fragments[k];
        double sum = 0, rigid_sum = 0, weights = 0;
        for (std::size_t j = 0; j < pairs_.size(); ++j) {
            const FragmentPlacement& other = result_.placement.fragments[j];
            if (j == k || !other.problem.empty() || !has_size(j)) continue;
            const double weight = weight_of(pairs_[j], other, false);
            sum += weight * other.own_scale;
            rigid_sum += weight * rigid_scale_of(pairs_[j], other);
            weights += weight;
        }
        if (weights > 0 && has_size(k)) judge_size(k, sum / weights, rigid_scale_of(pairs_[k], placement), rigid_sum / weights);
        const double count = static_cast<double>(std::count_if(placement.landmarks.begin(), placement.landmarks.end(),
                                                               [](const LandmarkResidual& mark) { return mark.used; }));
        const double spread = count > 0 ? std::sqrt(weight_of(pairs_[k], placement, true) / count) : 0;
        if (spread > 0) judge_landmarks(k, placement.residual / spread);
    }

    /// Whether a fragment's own landmarks determine its size. A fragment placed by its shape has the size given by the others.
    [[nodiscard]] bool has_size(std::size_t k) const {
        const FragmentPlacement& placement = result_.placement.fragments[k];
        return placement.own_scale > 0 && std::count_if(placement.landmarks.begin(), placement.landmarks.end(),
                                                        [](const LandmarkResidual& mark) { return mark.used; }) >= 3;
    }

    /// Residuals of the landmarks. If the distances between landmarks that move rigidly together, which posture preserves,
    /// deviate by no more than the tolerance of sizes, a different posture explains the residuals as well as a different shape.
    void judge_landmarks(std::size_t k, double relative_residual) {
        const FragmentPlacement& placement = result_.placement.fragments[k];
        const double overall_strain = relative_residual / std::max(options_.residual, 1e-9);
        const auto [from, to] = used_landmarks(pairs_[k], placement);
        const std::optional<double> strain = rigid_strain(from, to);
        const bool posture = strain && 100 * *strain <= options_.scale_tolerance;
        const std::string text = fmt::format("{} off those of the template (root mean square), {} % of their spread",
                                             digits(placement.residual, 3), digits(100 * relative_residual, 3));
        record_objection(ObjectionKind::landmarks, static_cast<int>(k), -1,
                         posture ? std::min(overall_strain, 1.0) : overall_strain, "its landmarks are " + text);
        if (posture && overall_strain > 1 && inconclusive_.empty())
            inconclusive_ = fmt::format(
                "the landmarks of fragment {} are {}, but distances between nearby ones differ by only {} %, which another "
                "posture than the template's explains as well as another shape",
                k + 1, text, digits(100 * *strain, 3));
    }

    /// Compares two sizes: from all landmarks, and from those that move rigidly together, which posture preserves. If only one
    /// of them contradicts the others, the size is too uncertain to be evidence against the fragment.
    void judge_size(std::size_t k, double other_scale, double rigid, double rigid_other_scale) {
        const double own_scale = result_.placement.fragments[k].own_scale, difference = per_cent_apart(own_scale, other_scale),
                     tolerance = std::max(options_.scale_tolerance, 1e-9);
        const double rigid_difference =
            rigid > 0 && rigid_other_scale > 0 ? per_cent_apart(rigid, rigid_other_scale) : difference;
        const std::string text =
            fmt::format("it alone would make the template {} times as large, the others {} times: its size is off by {} %",
                        digits(own_scale, 4), digits(other_scale, 4), digits(difference, 3));
        record_objection(ObjectionKind::size, static_cast<int>(k), -1, std::min(difference, rigid_difference) / tolerance, text);
        if (std::min(difference, rigid_difference) <= tolerance && std::max(difference, rigid_difference) > tolerance &&
            inconclusive_.empty())
            inconclusive_ = fmt::format(
                "the size of fragment {} is uncertain: it is off by {} % according to all landmarks and by {} % according to "
                "those that move together, which another posture than the template's explains as well as another size",
                k + 1, digits(difference, 3), digits(rigid_difference, 3));
    }

    /// Whether a fragment lies on the template, and does not overlap others.
    void judge_surface(std::size_t i) {
        const double lying = 100 * result_.object.on_template[i], shared = 100 * result_.object.shared[i];
        const int k = placed_[i];
        record_objection(ObjectionKind::surface, k, -1, (100 - lying) / std::max(100 - options_.min_on_template, 1e-9),
                         fmt::format("{} % of its outer surface lies on the fitted template, less than {} %: it has another "
                                     "shape or a wrong pose, or some of its faces are inside out or fracture surface",
                                     digits(lying, 3), digits(options_.min_on_template, 3)));
        record_objection(ObjectionKind::overlap, k, -1, shared / std::max(options_.overlap, 1e-9),
                         fmt::format("{} % of its outer surface lies where earlier fragments are observed, more than {} %: two "
                                     "fragments of one object do not overlap",
                                     digits(shared, 3), digits(options_.overlap, 3)));
    }

    void judge_constraint(const ConstraintReport& constraint) {
        std::string violations;
        double strain = 0;
        for (const Deviation& d : constraint.deviations) {
            if (!d.value || !d.tolerance) continue;
            const double allowed = d.unit == "%" ? std::max(options_.min_tolerance, *d.tolerance) : *d.tolerance;
            strain = std::max(strain, *d.value / std::max(allowed, 1e-12));
            if (*d.value > allowed)
                violations += fmt::format("{}{} {}, at most {}{}", violations.empty() ? "" : "; ", d.quantity,
                                          digits(*d.value, 4), digits(allowed, 4), d.unit.empty() ? "" : " " + d.unit);
        }
        strain = constraint.verdict == Verdict::fails ? strain : std::min(strain, 1.0);
        record_objection(ObjectionKind::constraint, -1, constraint.id, strain,
                         fmt::format("{} does not hold{}", constraint.type, violations.empty() ? "" : ": " + violations));
    }

    Reconstruction& result_;
    const std::vector<std::vector<LandmarkPair>>& pairs_;
    const std::vector<int>& placed_;
    const ReconstructOptions& options_;
    std::string inconclusive_;  ///< why sizes or landmarks are inconclusive
};

}  // namespace

void judge_reconstruction(Reconstruction& result, const std::vector<std::vector<LandmarkPair>>& pairs,
                          const std::vector<int>& placed, const ReconstructOptions& options) {
    Judge(result, pairs, placed, options).judge();
}

}  // namespace ostraka
