// Points found by where they are (k-d tree).
#pragma once

#include "ostraka/core/mesh.h"

#include <limits>
#include <memory>
#include <vector>

namespace ostraka {

/// Holds a copy of the points. Queries may run in parallel; of equally near points those of lower index come first.
class PointTree {
public:
    explicit PointTree(const std::vector<Point>& points = {});
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    [[nodiscard]] std::size_t size() const;

    struct Near {
        Index index = no_index;
        double squared = std::numeric_limits<double>::infinity();  ///< distance, squared
    };
    /// The nearest point no farther away than `search_radius`; none: no_index.
    [[nodiscard]] Near nearest(const Point& place, double search_radius = std::numeric_limits<double>::infinity()) const;
    /// The `count` nearest points, or all where there are fewer, nearest first.
    [[nodiscard]] std::vector<Near> neighbours(const Point& place, std::size_t count) const;
    /// All points no farther away than `search_radius`, by index.
    void within(const Point& place, double search_radius, std::vector<Index>& found) const;
    /// Squared distance of the farthest point; 0 where there is none.
    [[nodiscard]] double farthest_squared(const Point& place) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace ostraka
