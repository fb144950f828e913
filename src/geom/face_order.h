// The faces of a mesh in the order of a space-filling curve.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cstdint>
#include <memory>

namespace ostraka {

/// Non-degenerate faces sorted by the Morton codes of their centroids, so that faces close in space are close in the order. Faces
/// whose codes agree in the first 3k bits lie in one cube of side 1 / 2^k times the diagonal of the bounding box.
struct FaceOrder {
    std::unique_ptr<std::uint64_t[]> codes;  ///< Morton code of each face, 63 bits; ascending
    std::unique_ptr<Index[]> faces;          ///< index of each face; for equal codes the smaller index comes first
    std::uint32_t count = 0;                 ///< number of non-degenerate faces
    double area = 0;                         ///< area of all faces
};

/// `middle`: centre of the bounding box of the mesh; `diagonal`: its diagonal. Time: O(n), on all threads. Memory: 12 bytes per
/// face, and 12 more while sorting.
FaceOrder order_faces(const Mesh& mesh, const Point& middle, double diagonal);

}  // namespace ostraka
