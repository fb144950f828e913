// The faces of a mesh along a curve that fills space.
#pragma once

#include "ostraka/core/mesh.h"

#include <cstdint>
#include <memory>

namespace ostraka {

/// Faces that have an area, sorted by Morton codes of their centroids: what is near in space is near in this order. Those that
/// share their first 3k bits lie in one cube of 1 / 2^k of the box's diagonal.
struct FaceOrder {
    std::unique_ptr<std::uint64_t[]> codes;  ///< ascending, 63 bits
    std::unique_ptr<Index[]> faces;          ///< of equal codes the lower face first
    std::uint32_t count = 0;
    double area = 0;  ///< of all faces
};

/// `middle` is that of the mesh's box, `diagonal` its diagonal. O(n), on all threads; 12 bytes a face, and as many while it
/// sorts.
FaceOrder order_faces(const Mesh& mesh, const Point& middle, double diagonal);

}  // namespace ostraka
