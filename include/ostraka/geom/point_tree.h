// The points nearest to a place (k-d tree).
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/parallel.h"

#include <memory>
#include <vector>

namespace ostraka {

/// Holds a copy of the points. Queries may run in parallel; of equally near points the one of lowest index is the nearest.
class PointTree {
public:
    explicit PointTree(const std::vector<Point>& points);
    ~PointTree();
    PointTree(PointTree&&) noexcept;

    struct Near {
        Index index = no_index;
        double squared = 0;
    };
    /// The nearest point closer than `reach`; none: no_index.
    [[nodiscard]] Near nearest(const Point& place, double reach) const;
    /// All points closer than `reach`, by index.
    void within(const Point& place, double reach, std::vector<Index>& found) const;
    /// Distance of the `count`-th nearest point (1: the nearest); of the farthest where there are fewer.
    [[nodiscard]] double neighbour_distance(const Point& place, std::size_t count) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace ostraka
