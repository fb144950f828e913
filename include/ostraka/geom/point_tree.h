// Spatial search for points (k-d tree).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <limits>
#include <memory>
#include <vector>

namespace ostraka {

/// Holds a copy of the points. Queries may run in parallel; among equally near points, those of lower index come first.
class PointTree {
public:
    explicit PointTree(const std::vector<Point>& points = {});
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    [[nodiscard]] std::size_t size() const;

    struct Near {
        Index index = no_index;
        double squared = std::numeric_limits<double>::infinity();  ///< squared distance
    };
    /// The nearest point within `search_radius`; no_index if there is none.
    [[nodiscard]] Near nearest(const Point& place, double search_radius = std::numeric_limits<double>::infinity()) const;
    /// The `count` nearest points (all if there are fewer), nearest first.
    [[nodiscard]] std::vector<Near> neighbours(const Point& place, std::size_t count) const;
    /// All points within `search_radius`, by index.
    void within(const Point& place, double search_radius, std::vector<Index>& found) const;
    /// Squared distance of the farthest point; 0 if there are no points.
    [[nodiscard]] double farthest_squared(const Point& place) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace ostraka
