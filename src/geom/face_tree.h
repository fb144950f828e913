// Nearest faces of a mesh, among those whose normals agree.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace ostraka {

/// A hierarchy of boxes, each with a cone around the normals in it: where no normal can agree, a search goes no further, so that
/// it costs no more where the nearest faces are turned away. 50 bytes a face; building costs O(n log n).
class FaceTree {
public:
    /// Over these faces, which have an area. The mesh outlives it.
    FaceTree(const Mesh& mesh, const std::vector<Face>& faces);

    /// The nearest place within `reach` on a face whose unit normal has a scalar product of at least `min_cosine` with `normal`
    /// (-1: on any face); of equally near ones the face of the lowest index.
    [[nodiscard]] std::optional<SurfaceHit> closest(const Point& query, const Vector& normal, double min_cosine,
                                                    double reach) const;

private:
    struct Node {
        Eigen::AlignedBox3d box;
        Eigen::Vector3d axis;  ///< of the normals' cone
        double cosine, sine;   ///< of half its opening
        std::uint32_t first;   ///< face of a leaf; the second child of others, whose first is the next node
        std::uint32_t count;   ///< faces of a leaf; 0 for others
    };
    /// Normals' sum and cone, for the node above.
    void build(std::size_t begin, std::size_t end, const std::vector<Eigen::Vector3d>& centres,
               const std::vector<Eigen::Vector3d>& normals);

    const Mesh& mesh_;
    std::vector<Index> faces_;
    std::vector<Node> nodes_;
};

}  // namespace ostraka
