// The nodes of a glTF scene: which meshes it shows, and where.
#pragma once

#include "ostraka/io/glb.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka::io {

/// An affine map of points.
struct AffineMap {
    std::array<std::array<double, 3>, 3> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< rows of the matrix
    std::array<double, 3> shift{0, 0, 0};                                            ///< image of the origin

    [[nodiscard]] std::array<double, 3> operator()(const std::array<double, 3>& p) const;
    /// The map that applies `first`, then this map.
    [[nodiscard]] AffineMap after(const AffineMap& first) const;
    [[nodiscard]] bool mirrors() const;  ///< true if the determinant is negative
    friend bool operator==(const AffineMap&, const AffineMap&) = default;
};

/// A mesh that a node shows.
struct PlacedMesh {
    std::size_t mesh = 0;  ///< index of the mesh
    AffineMap placement;   ///< from the coordinates of the mesh to those of the scene
};

/// The meshes of the default scene, in the order of its nodes, parents before children; of all root nodes if the file has no
/// scene; each mesh once if it has no nodes. Nodes that only serve display do not transform. Throws Error (input) for nodes
/// that are reached twice (a cycle, or two parents).
std::vector<PlacedMesh> placed_meshes(const glb::Reader& reader, std::vector<std::string>& notes);

}  // namespace ostraka::io
