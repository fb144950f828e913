// The faces near a plane.
#pragma once

#include "ostraka/slicing/slice.h"

#include <Eigen/Geometry>

namespace ostraka::detail {

/// A binary tree of boxes over faces in the order of a curve through space, built once for many planes.
class PlaneSearch {
public:
    /// Over the given faces, or all. O(n log n).
    PlaneSearch(const Mesh& mesh, const std::vector<Index>& faces);

    /// Faces, ascending, whose boxes have heights within `search_radius` of the frame's origin.
    [[nodiscard]] std::vector<Index> near(const SliceFrame& frame, double search_radius) const;
    /// The lowest height of all faces.
    [[nodiscard]] double lowest(const SliceFrame& frame) const;

private:
    using Box = Eigen::AlignedBox3d;
    static constexpr std::size_t leaf = 8;
    [[nodiscard]] static Box box_of(const Mesh& mesh, Index face);
    /// Calls `visit(face)` for those in the boxes that, like all around them, are to be entered.
    template <class Enter, class Visit>
    void each_face(const Enter& enter, const Visit& visit) const;

    const Mesh& mesh_;
    std::vector<Index> faces_;
    std::size_t leaves_ = 1;
    std::vector<Box> boxes_;
};

}  // namespace ostraka::detail
