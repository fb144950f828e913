// Search for the faces near a plane.
#pragma once

#include "ostraka/slicing/slice.h"

#include <Eigen/Geometry>

namespace ostraka::detail {

/// A binary tree of bounding boxes over faces in the order of a space-filling curve, built once for many planes.
class PlaneSearch {
public:
    /// Builds the tree over the given faces (over all faces if the list is empty). Time: O(n log n).
    PlaneSearch(const Mesh& mesh, const std::vector<Index>& faces);

    /// The faces, ascending, whose bounding boxes come within `search_radius` of height 0 of the frame.
    [[nodiscard]] std::vector<Index> near(const SliceFrame& frame, double search_radius) const;
    /// The min height of all faces in the frame.
    [[nodiscard]] double lowest(const SliceFrame& frame) const;

private:
    using Box = Eigen::AlignedBox3d;
    static constexpr std::size_t leaf = 8;                          ///< number of faces per leaf
    [[nodiscard]] static Box box_of(const Mesh& mesh, Index face);  ///< bounding box of a face
    /// Calls `visit(face)` for the faces in the leaves for which `enter(box)` is true at every level of the tree.
    template <class Enter, class Visit>
    void each_face(const Enter& enter, const Visit& visit) const;

    const Mesh& mesh_;
    std::vector<Index> faces_;  ///< indices of the faces, along a space-filling curve
    std::size_t leaves_ = 1;    ///< number of leaves, a power of two
    std::vector<Box> boxes_;    ///< box of each node; the children of node i are 2 i and 2 i + 1
};

}  // namespace ostraka::detail
