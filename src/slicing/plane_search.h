// Search for the faces near a plane.
#pragma once

#include "ostraka/slicing/slice.h"

#include <Eigen/Geometry>

namespace ostraka::detail {

/// A binary tree of bounding boxes over faces in the order of a space-filling curve, built once for many planes.
class PlaneSearch {
public:
    /// Builds the tree over the given faces, or all faces. O(n log n).
    PlaneSearch(const Mesh& mesh, const std::vector<Index>& faces);

    /// The faces, ascending, whose boxes come within `search_radius` of height 0 of the frame.
    [[nodiscard]] std::vector<Index> near(const SliceFrame& frame, double search_radius) const;
    /// The minimum height of all faces.
    [[nodiscard]] double lowest(const SliceFrame& frame) const;

private:
    using Box = Eigen::AlignedBox3d;
    static constexpr std::size_t leaf = 8;
    [[nodiscard]] static Box box_of(const Mesh& mesh, Index face);
    /// Calls `visit(face)` for the faces in the boxes for which `enter` holds at every level.
    template <class Enter, class Visit>
    void each_face(const Enter& enter, const Visit& visit) const;

    const Mesh& mesh_;
    std::vector<Index> faces_;
    std::size_t leaves_ = 1;
    std::vector<Box> boxes_;
};

}  // namespace ostraka::detail
