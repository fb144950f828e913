#include "ostraka/registration/consistent.h"
#include "ostraka/core/angles.h"

#include <cmath>

namespace ostraka {

namespace {

Matrix3d frame(const Feature& feature) {
    Matrix3d m;
    m << feature.direction, feature.normal.cross(feature.direction), feature.normal;
    return m;
}

class MotionConsistency {
public:
    MotionConsistency(const FeatureSet& a, const FeatureSet& b, const std::vector<FeatureMatch>& matches,
                      const ConsistentOptions& options)
        : a_(a),
          b_(b),
          matches_(matches),
          tolerance_(options.tolerance * (a.size + b.size) / 2),
          cosine_(std::cos(options.angle * pi / 180)),
          used_a_(points(a)),
          used_b_(points(b)) {}

    /// The matches consistent with the motion; the first match of each salient point.
    const std::vector<std::size_t>& explained(const Motion& motion) {
        explained_.clear();
        ++stamp_;
        for (std::size_t i = 0; i < matches_.size(); ++i) {
            const Feature &from = a_.features[matches_[i].a], &to = b_.features[matches_[i].b];
            if ((motion(from.point) - to.point).squaredNorm() > tolerance_ * tolerance_) continue;
            if ((motion.rotation * from.normal).dot(to.normal) < cosine_) continue;
            if (used_a_[from.vertex] == stamp_ || used_b_[to.vertex] == stamp_) continue;
            used_a_[from.vertex] = used_b_[to.vertex] = stamp_;
            explained_.push_back(i);
        }
        return explained_;
    }

private:
    static std::vector<std::uint32_t> points(const FeatureSet& set) {
        Index last = 0;
        for (const Feature& feature : set.features) last = std::max(last, feature.vertex);
        return std::vector<std::uint32_t>(last + std::size_t{1}, 0);
    }
    const FeatureSet &a_, &b_;
    const std::vector<FeatureMatch>& matches_;
    double tolerance_, cosine_;
    std::vector<std::uint32_t> used_a_, used_b_;
    std::uint32_t stamp_ = 0;
    std::vector<std::size_t> explained_;
};

}  // namespace

ConsistentMatches consistent_matches(const FeatureSet& a, const FeatureSet& b, const std::vector<FeatureMatch>& matches,
                                     const ConsistentOptions& options) {
    check_options(options, "matches");
    ConsistentMatches result;
    MotionConsistency consistency(a, b, matches, options);
    std::vector<std::size_t> best;
    for (const FeatureMatch& match : matches) {
        const Feature &from = a.features[match.a], &to = b.features[match.b];
        Motion motion;
        motion.rotation = frame(to) * frame(from).transpose();
        motion.translation = to.point - motion.rotation * from.point;
        const auto& explained = consistency.explained(motion);
        if (explained.size() <= best.size()) continue;
        best = explained;
        result.motion = motion;
    }
    FitOptions fit;
    fit.scale = options.shrinkage > 0;
    fit.min_scale = 1 - options.shrinkage;
    fit.max_scale = 1 / (1 - options.shrinkage);
    for (int round = 0; round < 10 && best.size() >= 3; ++round) {
        std::vector<Vector3d> from, to;
        for (const std::size_t i : best) {
            from.push_back(a.features[matches[i].a].point);
            to.push_back(b.features[matches[i].b].point);
        }
        const Motion motion = fit_motion(from, to, {}, fit);
        const auto& explained = consistency.explained(motion);
        if (explained.size() < best.size()) break;
        const bool unchanged = explained == best;
        best = explained;
        result.motion = motion;
        if (unchanged) break;
    }
    for (const std::size_t i : best) result.matches.push_back(matches[i]);
    return result;
}

void ConsistentOptions::declare_options(OptionList& list) {
    list("tolerance", tolerance, "maximum distance between matched features after registration", Range{0, 1},
         "share of the size");
    list("normal-angle", angle, "maximum angle between the normals of matched features", Range{0, 180}, "degrees");
    list("shrinkage", shrinkage, "maximum relative difference in size between two objects; 0: rigid registration", Range{0, 0.5});
}

}  // namespace ostraka
