// Search for the nearest point on curves given as ordered lists of many short segments.
#pragma once

#include "ostraka/geom/circle.h"

#include <algorithm>
#include <limits>

namespace ostraka::detail {

/// A binary tree of bounding boxes over consecutive segments. Neighbours in the list are neighbours in the plane, so that no
/// sorting is needed.
class SegmentTree {
public:
    explicit SegmentTree(PlaneSegments segments) : segments_(std::move(segments)) {
        while (leaves_ * leaf < segments_.size()) leaves_ *= 2;
        boxes_.resize(2 * leaves_);
        for (std::size_t i = 0; i < segments_.size(); ++i)
            for (const auto& p : {segments_[i].first, segments_[i].second}) boxes_[leaves_ + i / leaf].extend(p);
        for (std::size_t n = leaves_ - 1; n > 0; --n) boxes_[n].extend(boxes_[2 * n]), boxes_[n].extend(boxes_[2 * n + 1]);
    }

    /// Distance from `p` to the nearest segment. `hint`: index of a segment near `p`, replaced by the index of the nearest
    /// segment.
    double distance(const Eigen::Vector2d& p, std::size_t& hint) const {
        double best = squared(p, hint);
        search(1, p, best, hint);
        return std::sqrt(best);
    }

private:
    static constexpr std::size_t leaf = 4;  ///< number of segments per leaf
    struct Box {
        Eigen::Vector2d low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        Eigen::Vector2d high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        void extend(const Eigen::Vector2d& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
        void extend(const Box& box) { low = low.cwiseMin(box.low), high = high.cwiseMax(box.high); }
        [[nodiscard]] double squared(const Eigen::Vector2d& p) const {
            return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
        }
    };
    /// Squared distance from p to segment i.
    [[nodiscard]] double squared(const Eigen::Vector2d& p, std::size_t i) const {
        const auto& [a, b] = segments_[i];
        const Eigen::Vector2d along = b - a;
        const double length = along.squaredNorm();
        const double t = length > 0 ? std::clamp(along.dot(p - a) / length, 0.0, 1.0) : 0;
        return (a + t * along - p).squaredNorm();
    }
    /// Searches the subtree of a node for a segment nearer than `best`, a squared distance.
    void search(std::size_t node, const Eigen::Vector2d& p, double& best, std::size_t& nearest) const {
        if (node >= leaves_) {
            const std::size_t first = (node - leaves_) * leaf;
            for (std::size_t i = first; i < std::min(first + leaf, segments_.size()); ++i)
                if (const double d = squared(p, i); d < best) best = d, nearest = i;
            return;
        }
        const double left = boxes_[2 * node].squared(p), right = boxes_[2 * node + 1].squared(p);
        const std::size_t first = left <= right ? 2 * node : 2 * node + 1, second = left <= right ? 2 * node + 1 : 2 * node;
        if (std::min(left, right) < best) search(first, p, best, nearest);
        if (std::max(left, right) < best) search(second, p, best, nearest);
    }

    PlaneSegments segments_;  ///< the segments of the curves, in order
    std::size_t leaves_ = 1;  ///< number of leaves, a power of two
    std::vector<Box> boxes_;  ///< box of each node; the children of node i are 2 i and 2 i + 1
};

}  // namespace ostraka::detail
