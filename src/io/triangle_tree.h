// A box tree over the triangles of a soup: pairs of overlapping boxes, triangles along a segment, the nearest triangle.
// Private to the module.
#pragma once

#include "ostraka/core/mesh.h"

#include <functional>
#include <vector>

namespace ostraka::detail {

/// Triangles are sorted along a space-filling (Morton) curve; four neighbours make a leaf, four nodes make a node of the
/// next level. Boxes are single precision in coordinates scaled to the object's box and rounded outwards, so that an
/// overlap is never missed. Building takes time linear in the number of triangles. The soup must outlive the tree.
class TriangleTree {
public:
    explicit TriangleTree(const TriangleSoup& soup) : TriangleTree(soup, {}) {}
    /// `groups`: of each triangle, `left_out` for one that is not in the tree; two of the same group other than 0 are no pair.
    /// Triangles of a group stand side by side, so that whole branches of one are passed over.
    TriangleTree(const TriangleSoup& soup, std::vector<Index> groups);
    static constexpr Index left_out = no_index;

    static constexpr Index fan = 4;
    [[nodiscard]] Index leaf_count() const { return levels_.empty() ? 0 : static_cast<Index>(levels_.front().size()); }

    /// Calls visit(a, b) for each pair of triangles with overlapping boxes where `a` lies in the given leaf and `b` comes
    /// later on the curve, always in the same order; stops when `visit` returns false, or after about so many comparisons of
    /// boxes. Over all leaves, each pair comes once. Returns the number of comparisons.
    std::size_t pairs_of_leaf(Index leaf, std::size_t most, const std::function<bool(Index, Index)>& visit) const;

    /// Calls visit(t) for each triangle whose box meets the segment; stops after about so many boxes.
    void along_segment(const Point& from, const Point& to, std::size_t most, const std::function<void(Index)>& visit) const;

    struct Nearest {
        Index triangle = no_index;
        double squared_distance = 0;
    };
    /// The triangle nearest to the point (the lowest index among equals), no_index if there are none.
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
    std::array<double, 3> corner_{};  ///< of the object's box
    double scale_ = 1;                ///< 1 / longest side of the object's box
    std::vector<Index> order_;        ///< triangles along the curve
    std::vector<Box> boxes_;          ///< of the triangles in that order
    std::vector<std::vector<Box>> levels_;
    std::vector<Index> groups_;                     ///< of triangles, or empty
    std::vector<std::vector<Index>> level_groups_;  ///< of nodes: that of all their triangles, else 0
};

/// Squared distance from a point to a triangle, which may be degenerate.
double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c);

}  // namespace ostraka::detail
