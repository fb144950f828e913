// A tree of bounding boxes over the triangles of a soup. Queries: pairs of overlapping boxes, triangles along a segment, the
// nearest triangle. Private to the module.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>
#include <vector>

namespace ostraka::detail {

/// Triangles are sorted along a space-filling (Morton) curve; four consecutive ones form a leaf, four nodes form a node of the
/// next level. Boxes have single precision in coordinates scaled to the object's box and are rounded outwards, so that no
/// overlap is missed. Construction takes linear time in the number of triangles. The soup must outlive the tree.
class TriangleTree {
public:
    explicit TriangleTree(const TriangleSoup& soup) : TriangleTree(soup, {}) {}
    /// `groups`: group of each triangle; `left_out` excludes a triangle from the tree; triangles of the same non-zero group are
    /// not reported as pairs. Triangles of a group are stored consecutively, so that branches within one group are skipped.
    TriangleTree(const TriangleSoup& soup, std::vector<Index> groups);
    static constexpr Index left_out = no_index;

    static constexpr Index fan = 4;
    [[nodiscard]] Index leaf_count() const { return levels_.empty() ? 0 : static_cast<Index>(levels_.front().size()); }

    /// Calls visit(a, b) for each pair of triangles with overlapping boxes where `a` lies in the given leaf and `b` comes later
    /// on the curve, always in the same order. Stops when `visit` returns false or after about `max_boxes` comparisons of boxes.
    /// Over all leaves, each pair is visited once. Returns the number of comparisons.
    std::size_t pairs_of_leaf(Index leaf, std::size_t max_boxes, const std::function<bool(Index, Index)>& visit) const;

    /// Calls visit(t) for each triangle whose box intersects the segment; stops after about `max_boxes` boxes.
    void along_segment(const Point& from, const Point& to, std::size_t max_boxes, const std::function<void(Index)>& visit) const;

    struct Nearest {
        Index triangle = no_index;
        double squared_distance = 0;
    };
    /// The triangle nearest to the point (for equal distances, the lowest index); no_index if there are no triangles.
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
    std::array<double, 3> corner_{};  ///< lower corner of the object's box
    double scale_ = 1;                ///< 1 / longest side of the object's box
    std::vector<Index> order_;        ///< triangles in the order of the curve
    std::vector<Box> boxes_;          ///< boxes of the triangles in that order
    std::vector<std::vector<Box>> levels_;
    std::vector<Index> groups_;                     ///< per triangle, or empty
    std::vector<std::vector<Index>> level_groups_;  ///< per node: the common group of its triangles, else 0
};

/// Squared distance from a point to a triangle, which may be degenerate.
double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

}  // namespace ostraka::detail
