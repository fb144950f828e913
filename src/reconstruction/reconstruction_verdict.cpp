#include "reconstruction_verdict.h"

#include "ostraka/core/text.h"
#include "ostraka/core/words.h"
#include "ostraka/reconstruction/rigid_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace ostraka {

std::string to_string(ObjectionKind kind) {
    return word_for(kind, {"placement", "size", "landmarks", "surface", "overlap", "constraint"});
}

std::string to_string(Compatibility compatibility) {
    return word_for(compatibility, {"compatible", "incompatible", "undecided"});
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
                objection(ObjectionKind::placement, static_cast<int>(k), -1, 0, result_.placement.fragments[k].problem);
            return;
        }
        std::size_t placed = 0;
        for (std::size_t k = 0; k < pairs_.size(); ++k) {
            const FragmentPlacement& one = result_.placement.fragments[k];
            if (!one.problem.empty()) {
                objection(ObjectionKind::placement, static_cast<int>(k), -1, 0, "not placed: " + one.problem);
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
        const bool against = std::any_of(result_.objections.begin(), result_.objections.end(),
                                         [](const Objection& one) { return one.kind != ObjectionKind::placement; });
        if (against) {
            result_.verdict = Compatibility::incompatible;
        } else if (placed < pairs_.size()) {
            result_.undecided = "not all fragments could be placed";
        } else if (result_.rotations && std::any_of(result_.rotations->notes.begin(), result_.rotations->notes.end(),
                                                    [](const std::string& note) { return !note.empty(); })) {
            result_.undecided = "the turns of some fragments about the axis are not decided";
        } else if (!unsure_.empty()) {
            result_.undecided = unsure_;
        } else if (placed == 1 && !tested) {
            result_.undecided = "one fragment and no constraint: nothing can contradict it";
        } else {
            result_.verdict = Compatibility::compatible;
        }
    }

private:
    void objection(ObjectionKind kind, int fragment, int constraint, double strain, const std::string& text) {
        result_.strain = std::max(result_.strain, strain);
        if (kind == ObjectionKind::placement || strain > 1)
            result_.objections.push_back({kind, fragment, constraint, strain, text});
    }

    /// Compares a fragment's size with that of the others, and its landmarks with the template's.
    void judge_fragment(std::size_t k) {
        const FragmentPlacement& one = result_.placement.fragments[k];
        double sum = 0, rigid_sum = 0, weights = 0;
        for (std::size_t j = 0; j < pairs_.size(); ++j) {
            const FragmentPlacement& other = result_.placement.fragments[j];
            if (j == k || !other.problem.empty() || !has_size(j)) continue;
            const double weight = weight_of(pairs_[j], other, false);
            sum += weight * other.own_scale;
            rigid_sum += weight * rigid_scale_of(pairs_[j], other);
            weights += weight;
        }
        if (weights > 0 && has_size(k)) judge_size(k, sum / weights, rigid_scale_of(pairs_[k], one), rigid_sum / weights);
        const double count = static_cast<double>(
            std::count_if(one.landmarks.begin(), one.landmarks.end(), [](const LandmarkResidual& mark) { return mark.used; }));
        const double spread = count > 0 ? std::sqrt(weight_of(pairs_[k], one, true) / count) : 0;
        if (spread > 0) judge_landmarks(k, one.residual / spread);
    }

    /// Whether a fragment's own landmarks determine its size. A fragment placed by its shape has the size given by the others.
    [[nodiscard]] bool has_size(std::size_t k) const {
        const FragmentPlacement& one = result_.placement.fragments[k];
        return one.own_scale > 0 && std::count_if(one.landmarks.begin(), one.landmarks.end(),
                                                  [](const LandmarkResidual& mark) { return mark.used; }) >= 3;
    }

    /// Residuals of the landmarks. If the distances between landmarks that move rigidly together, which posture preserves,
    /// deviate by no more than the tolerance of sizes, a different posture explains the residuals as well as a different shape.
    void judge_landmarks(std::size_t k, double off) {
        const FragmentPlacement& one = result_.placement.fragments[k];
        const double strain_of_all = off / std::max(options_.residual, 1e-9);
        const auto [from, to] = used_landmarks(pairs_[k], one);
        const std::optional<double> strain = rigid_strain(from, to);
        const bool posture = strain && 100 * *strain <= options_.scale_tolerance;
        const std::string text = digits(one.residual, 3) + " off those of the template (root mean square), " +
                                 digits(100 * off, 3) + " % of their spread";
        objection(ObjectionKind::landmarks, static_cast<int>(k), -1, posture ? std::min(strain_of_all, 1.0) : strain_of_all,
                  "its landmarks are " + text);
        if (posture && strain_of_all > 1 && unsure_.empty())
            unsure_ = "the landmarks of fragment " + std::to_string(k + 1) + " are " + text + ", but distances of near ones by " +
                      digits(100 * *strain, 3) +
                      " % only, which a posture unlike the template's explains as well as another shape";
    }

    /// Compares two sizes: from all landmarks, and from those that move rigidly together, which posture preserves. If only one
    /// of them contradicts the others, the size is too uncertain to be evidence against the fragment.
    void judge_size(std::size_t k, double others, double rigid, double rigid_others) {
        const double own = result_.placement.fragments[k].own_scale, off = per_cent_apart(own, others),
                     tolerance = std::max(options_.scale_tolerance, 1e-9);
        const double rigid_off = rigid > 0 && rigid_others > 0 ? per_cent_apart(rigid, rigid_others) : off;
        const std::string text = "alone it would have the template " + digits(own, 4) + " times as large, and the others " +
                                 digits(others, 4) + " times: its size is off by " + digits(off, 3) + " %";
        objection(ObjectionKind::size, static_cast<int>(k), -1, std::min(off, rigid_off) / tolerance, text);
        if (std::min(off, rigid_off) <= tolerance && std::max(off, rigid_off) > tolerance && unsure_.empty())
            unsure_ = "the size of fragment " + std::to_string(k + 1) + " is uncertain: it is off by " + digits(off, 3) +
                      " % by all landmarks and by " + digits(rigid_off, 3) +
                      " % by those that move together, which a posture unlike the template's explains as well as another size";
    }

    /// Whether a fragment lies on the template, and does not overlap others.
    void judge_surface(std::size_t i) {
        const double lying = 100 * result_.object.lying[i], shared = 100 * result_.object.shared[i];
        const int k = placed_[i];
        objection(ObjectionKind::surface, k, -1, (100 - lying) / std::max(100 - options_.lying, 1e-9),
                  digits(lying, 3) + " % of its outer surface lies on the fitted template, at least " +
                      digits(options_.lying, 3) +
                      " %: another shape, a wrong place, or faces that are inside out or of its break");
        objection(ObjectionKind::overlap, k, -1, shared / std::max(options_.overlap, 1e-9),
                  digits(shared, 3) + " % of its outer surface lies where fragments before it are seen, at most " +
                      digits(options_.overlap, 3) + " %: two fragments of one object have none in common");
    }

    void judge_constraint(const ConstraintReport& constraint) {
        std::string words;
        double strain = 0;
        for (const Deviation& d : constraint.deviations) {
            if (!d.value || !d.tolerance) continue;
            const double allowed = d.unit == "%" ? std::max(options_.slack, *d.tolerance) : *d.tolerance;
            strain = std::max(strain, *d.value / std::max(allowed, 1e-12));
            if (*d.value > allowed)
                words += (words.empty() ? "" : "; ") + d.quantity + " " + digits(*d.value, 4) + ", at most " +
                         digits(allowed, 4) + (d.unit.empty() ? "" : " " + d.unit);
        }
        strain = constraint.verdict == Verdict::fails ? strain : std::min(strain, 1.0);
        objection(ObjectionKind::constraint, -1, constraint.id, strain,
                  constraint.type + " does not hold" + (words.empty() ? "" : ": " + words));
    }

    Reconstruction& result_;
    const std::vector<std::vector<LandmarkPair>>& pairs_;
    const std::vector<int>& placed_;
    const ReconstructOptions& options_;
    std::string unsure_;  ///< why sizes or landmarks are inconclusive
};

}  // namespace

void judge_reconstruction(Reconstruction& result, const std::vector<std::vector<LandmarkPair>>& pairs,
                          const std::vector<int>& placed, const ReconstructOptions& options) {
    Judge(result, pairs, placed, options).judge();
}

}  // namespace ostraka
