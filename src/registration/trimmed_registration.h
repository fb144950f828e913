// Trimmed ICP, point to plane: the part of the algorithm that does not depend on how points are paired.
#pragma once

#include "ostraka/geom/plane_motion.h"

#include <algorithm>
#include <vector>

namespace ostraka::detail {

/// A moved point, its partner `place` on the other surface, and the normal of the tangent plane at the partner.
struct PlanePair {
    Eigen::Vector3d point, place, normal;
    double squared = 0;  ///< squared distance of the point from its partner
};

/// Quality of a pose: value of the minimised objective, residual of the kept pairs, share of the samples that have a pair.
struct PoseFit {
    double minimised = 0, residual = 0, overlap = 0;
};

/// The point pairs of one ICP step.
class PlanePairs {
public:
    std::vector<PlanePair> pairs;

    /// Keeps the pairs of smallest distance, at most `share` of `samples` and at least one; returns the number of pairs that
    /// would be kept if every sample had a partner.
    std::size_t trim(double share, std::size_t samples) {
        const auto kept_count = std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(samples)));
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const PlanePair& a, const PlanePair& b) { return a.squared < b.squared; });
        if (pairs.size() > kept_count) pairs.resize(kept_count);
        return kept_count;
    }
    /// Sum of the squared distances of the points from their planes.
    [[nodiscard]] double squares() const {
        double sum = 0;
        for (const PlanePair& pair : pairs) {
            const double distance = pair.normal.dot(pair.point - pair.place);
            sum += distance * distance;
        }
        return sum;
    }
    /// Linearised motion of the points onto their planes, about the centre of the points; `unit`: length by which lengths are
    /// divided.
    [[nodiscard]] PlaneMotion planes(double unit) const {
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (const PlanePair& pair : pairs) centre += pair.point / static_cast<double>(pairs.size());
        PlaneMotion planes(centre, unit);
        for (const PlanePair& pair : pairs) planes.add(pair.point, pair.normal, pair.normal.dot(pair.place - pair.point));
        return planes;
    }
};

/// Result of `register_from`.
struct Registration {
    Motion pose;             ///< best pose encountered
    PoseFit fit;             ///< quality of this pose
    int iterations = 0;      ///< number of steps
    bool converged = false;  ///< true: the last steps did not improve the pose
};

/// ICP from the pose `start`: measure(pose) fills `pairs` and returns the fit, step(pose) returns the next pose. As the pairs
/// change from step to step, the objective may rise for a while: the best pose encountered is returned. Stops after several steps
/// that decrease the objective by less than the share `min_gain`.
template <class Measure, class Step>
Registration register_from(const Motion& start, int iterations, double min_gain, const PlanePairs& pairs, Measure&& measure,
                           Step&& step) {
    constexpr int patience = 4;
    Registration result{start, measure(start)};
    Motion pose = start;
    for (int steps_without_gain = 0; result.iterations < iterations && steps_without_gain < patience && pairs.pairs.size() >= 6;
         ++result.iterations) {
        pose = step(pose);
        const PoseFit current = measure(pose);
        steps_without_gain = current.minimised < result.fit.minimised * (1 - min_gain) ? 0 : steps_without_gain + 1;
        if (current.minimised < result.fit.minimised) result.pose = pose, result.fit = current;
        result.converged = steps_without_gain >= patience;
    }
    return result;
}

}  // namespace ostraka::detail
