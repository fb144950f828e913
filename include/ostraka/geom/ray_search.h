// Rays inside a solid: the first face through which a ray leaves it.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <memory>
#include <optional>

namespace ostraka {

/// Where a ray leaves a solid.
struct RayExit {
    Index face = no_index;  ///< the face through which the ray leaves
    double distance = 0;    ///< distance from the origin of the ray
};

/// A search tree for rays over the faces of a mesh, which must outlive the tree and have no garbage. Queries may run in parallel.
/// Degenerate faces are ignored. A query typically costs O(log n): nodes are visited in the order in which the ray reaches them
/// (Wald, Boulos and Shirley 2007), and nodes whose faces all point towards the origin are skipped.
class RaySearch {
public:
    /// Builds the tree in O(n) on all threads; results do not depend on the number of threads.
    explicit RaySearch(const Mesh& mesh);
    ~RaySearch();
    RaySearch(RaySearch&&) noexcept;

    /// The first face, other than `ignored`, that the ray crosses from inside (the scalar product of its normal and `direction`,
    /// a unit vector, is positive) at a distance above `min_distance`; ties go to the lowest face index. Distances are limited
    /// to 1.01 times the diagonal of the mesh's bounding box. Which faces the ray crosses is exact for the rounded end point.
    [[nodiscard]] std::optional<RayExit> first_exit(const Point& origin, const Vector& direction, Index ignored,
                                                    double min_distance) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace ostraka
