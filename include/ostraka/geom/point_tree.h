// Spatial search for points (k-d tree).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <limits>
#include <memory>
#include <vector>

namespace ostraka {

/// A k-d tree that holds a copy of the points. Queries may run in parallel. Among points at equal distance, the point with the
/// lower index comes first.
class PointTree {
public:
    explicit PointTree(const std::vector<Point>& points = {});
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    [[nodiscard]] std::size_t size() const;  ///< number of points

    struct Near {
        Index index = no_index;                                    ///< index of the point; no_index: none
        double squared = std::numeric_limits<double>::infinity();  ///< squared distance from the query point
    };
    /// The point closest to `place` within `search_radius`; its index is no_index if there is none.
    [[nodiscard]] Near nearest(const Point& place, double search_radius = std::numeric_limits<double>::infinity()) const;
    /// The `count` points closest to `place` (all points if there are fewer), closest first.
    [[nodiscard]] std::vector<Near> neighbours(const Point& place, std::size_t count) const;
    /// Sets `found` to the indices of all points within `search_radius` of `place`, ascending.
    void within(const Point& place, double search_radius, std::vector<Index>& found) const;
    /// Squared distance from `place` to the farthest point; 0 if there are no points.
    [[nodiscard]] double farthest_squared(const Point& place) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace ostraka
