// The faces of a mesh in the order of a space-filling curve.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cstdint>
#include <memory>

namespace ostraka {

/// Non-degenerate faces sorted by the Morton codes of their centroids, so that faces close in space are close in the order.
/// Faces with the same first 3k bits lie in one cube of side 1 / 2^k of the box diagonal.
struct FaceOrder {
    std::unique_ptr<std::uint64_t[]> codes;  ///< ascending, 63 bits
    std::unique_ptr<Index[]> faces;          ///< for equal codes, the lower face first
    std::uint32_t count = 0;
    double area = 0;  ///< of all faces
};

/// `middle`: centre of the bounding box of the mesh; `diagonal`: its diagonal. O(n), on all threads; 12 bytes per face, and as
/// many again while sorting.
FaceOrder order_faces(const Mesh& mesh, const Point& middle, double diagonal);

}  // namespace ostraka
