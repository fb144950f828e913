// Nearest faces of a mesh among those with compatible normals, and the faces that a segment intersects.
#pragma once

#include "ostraka/geom/surface_search.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace ostraka {

struct FaceOrder;

/// A hierarchy of bounding boxes with cones of normals. A nearest-face search skips nodes without compatible normals, so that
/// it stays fast where the nearest faces are turned away. About 50 bytes per face. Construction costs O(n), on all threads; the
/// tree does not depend on their number.
class FaceTree {
public:
    /// Built over the non-degenerate faces. The mesh must outlive the tree and have no garbage.
    explicit FaceTree(const Mesh& mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// Number of non-degenerate faces; area of all faces; diagonal of the bounding box of the mesh.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] double diagonal() const { return unit_; }

    /// The nearest point within `search_radius` on a face whose unit normal has a scalar product of at least `min_cosine` with
    /// `normal` (-1: any face); ties go to the lowest face index.
    [[nodiscard]] std::optional<SurfaceHit> closest(const Point& query, const Vector& normal, double min_cosine,
                                                    double search_radius) const;

    /// The faces that the segment intersects, in unspecified order. Exact for the given coordinates.
    [[nodiscard]] std::vector<Index> met(const Point& from, const Point& to) const;

    /// Whether the segment intersects a face that `ignored` does not accept. Exact for the given coordinates.
    [[nodiscard]] bool meets(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const;

private:
    using Place = Eigen::Array4f;  ///< about the centre of the bounding box, in diagonals; last number: other use
    /// One cache line.
    struct alignas(64) Node {
        Place low, high;      ///< the last number is 0
        Place cone;           ///< axis of the normal cone, and the cosine of half its opening angle
        float sine;           ///< of half the opening angle of the cone
        std::uint32_t first;  ///< leaf: its first triangle; inner node: its second child (the first child is the next node)
        std::uint32_t count;  ///< number of triangles of a leaf; 0 for inner nodes
    };
    struct Triangle {
        std::array<Index, 3> corners;
        Index face;
    };
    struct Search;
    void build(const FaceOrder& order);
    std::uint32_t build(const FaceOrder& order, std::uint32_t begin, std::uint32_t end, std::uint32_t node);
    void fill(const FaceOrder& order, std::uint32_t begin, std::uint32_t end, Node& leaf);
    void join(std::uint32_t node);
    [[nodiscard]] Eigen::Vector3d place(const Point& p) const;
    template <class Visit>
    void along(const Point& from, const Point& to, const Visit& visit) const;

    const Mesh& mesh_;
    Point middle_;
    double unit_ = 1, scale_ = 1;  ///< the diagonal, and its reciprocal
    double area_ = 0;
    std::size_t size_ = 0;
    std::unique_ptr<Node[]> nodes_;
    std::unique_ptr<Triangle[]> triangles_;
};

}  // namespace ostraka
