// A tree of bounding boxes over the triangles of a soup. Queries: pairs of overlapping boxes, triangles along a segment, the
// nearest triangle. Private to the module.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>
#include <vector>

namespace ostraka::detail {

/// A tree of bounding boxes. Triangles are sorted along a space-filling (Morton) curve; four consecutive triangles form a leaf,
/// and four consecutive nodes form a node of the next level. Boxes have single precision in coordinates scaled to the object's
/// box and are rounded outwards, so that no overlap is missed. Construction takes linear time in the number of triangles. The
/// soup must outlive the tree.
class TriangleTree {
public:
    explicit TriangleTree(const TriangleSoup& soup) : TriangleTree(soup, {}) {}
    /// `groups`: for each triangle the number of its group, or `left_out` to exclude the triangle from the tree (empty: no
    /// groups). Triangles of the same non-zero group are not reported as pairs. Triangles of a group are stored consecutively, so
    /// that branches within one group are skipped.
    TriangleTree(const TriangleSoup& soup, std::vector<Index> groups);
    static constexpr Index left_out = no_index;  ///< group number of triangles that are not in the tree

    static constexpr Index fan = 4;  ///< number of children of a node
    /// Number of leaves.
    [[nodiscard]] Index leaf_count() const { return levels_.empty() ? 0 : static_cast<Index>(levels_.front().size()); }

    /// Calls visit(a, b) for each pair of triangles with overlapping boxes where `a` lies in the given leaf and `b` comes after
    /// `a` on the curve; the order of the calls is always the same. Stops when `visit` returns false or after about `max_boxes`
    /// comparisons of boxes. Over all leaves, each pair is visited once. Returns the number of comparisons.
    std::size_t pairs_of_leaf(Index leaf, std::size_t max_boxes, const std::function<bool(Index, Index)>& visit) const;

    /// Calls visit(t) for each triangle whose box intersects the segment; stops after about `max_boxes` boxes.
    void along_segment(const Point& from, const Point& to, std::size_t max_boxes, const std::function<void(Index)>& visit) const;

    struct Nearest {
        Index triangle = no_index;    ///< index of the triangle
        double squared_distance = 0;  ///< squared distance of the query point from the triangle
    };
    /// The triangle closest to the point (at equal distances, the smallest index); no_index if there are no triangles.
    [[nodiscard]] Nearest nearest(const Point& query) const;

private:
    struct Box {
        std::array<float, 3> low, high;
    };
    [[nodiscard]] Box scaled_box(const std::array<double, 3>& low, const std::array<double, 3>& high) const;
    static bool overlap(const Box& a, const Box& b);
    void find_frame();
    void order_triangles();
    void find_boxes();
    void group_nodes();

    const TriangleSoup& soup_;
    std::array<double, 3> corner_{};        ///< lower corner of the object's box
    double scale_ = 1;                      ///< 1 / longest side of the object's box
    std::vector<Index> order_;              ///< indices of the triangles in the order of the curve
    std::vector<Box> boxes_;                ///< boxes of the triangles in the order of the curve
    std::vector<std::vector<Box>> levels_;  ///< boxes of the nodes, level by level, leaves first
    std::vector<Index> groups_;             ///< per triangle: number of its group; empty: no groups
    /// Per level and node: group of all triangles of the node; 0 if they have no common group.
    std::vector<std::vector<Index>> level_groups_;
};

/// Squared distance from a point to a triangle, which may be degenerate.
double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

}  // namespace ostraka::detail
