// Nearest faces of a mesh, among those whose normals agree.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace ostraka {

/// A hierarchy of boxes, each with a cone around the normals in it: where no normal can agree, a search goes no further, so that
/// it costs no more where the nearest faces are turned away. 20 to 30 bytes a face; building costs O(n log n).
class FaceTree {
public:
    /// Over these faces, which have an area. The mesh outlives it.
    FaceTree(const Mesh& mesh, const std::vector<Face>& faces);

    /// The nearest place within `search_radius` on a face whose unit normal has a scalar product of at least `min_cosine` with
    /// `normal`
    /// (-1: on any face); of equally near ones the face of the lowest index.
    [[nodiscard]] std::optional<SurfaceHit> closest(const Point& query, const Vector& normal, double min_cosine,
                                                    double search_radius) const;

private:
    using Place = std::array<float, 3>;  ///< about the mesh's middle, in diagonals of its box
    struct Node {
        Place low, high;
        Place axis;           ///< of the normals' cone
        float cosine, sine;   ///< of half its opening
        std::uint32_t first;  ///< face of a leaf; the second child of others, whose first is the next node
        std::uint32_t count;  ///< faces of a leaf; 0 for others
    };
    struct Item {
        Place centre;
        Index face;
    };
    struct Range {
        std::uint32_t node, begin, end;
    };
    void build(const Range& range, std::vector<Item>& items);
    std::array<Range, 2> split(const Range& range, std::vector<Item>& items);
    void fill(const Range& leaf, std::vector<Item>& items);
    void join(std::uint32_t node);
    [[nodiscard]] Eigen::Vector3d place(const Point& p) const;

    const Mesh& mesh_;
    Point middle_;
    double unit_ = 1;
    std::vector<Index> faces_;
    std::vector<Node> nodes_;
};

}  // namespace ostraka
