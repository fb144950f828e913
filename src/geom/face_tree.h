// Search tree for the closest face with a compatible normal, and for the faces that a segment intersects.
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

/// A hierarchy of bounding boxes with cones of normals. A closest-face query skips nodes without compatible normals, so that the
/// query stays fast where the closest faces are turned away. Memory: about 50 bytes per face. Construction takes O(n) on all
/// threads; the tree does not depend on the number of threads.
class FaceTree {
public:
    /// Builds the tree over the non-degenerate faces. The mesh must outlive the tree and have no garbage.
    explicit FaceTree(const Mesh& mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// Number of non-degenerate faces.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] double area() const { return area_; }      ///< area of all faces
    [[nodiscard]] double diagonal() const { return unit_; }  ///< diagonal of the bounding box of the mesh

    /// The point closest to `query` within `search_radius` on a face whose unit normal has a scalar product of at least
    /// `min_cosine` with `normal` (-1: any face); ties go to the lowest face index.
    [[nodiscard]] std::optional<SurfaceHit> closest(const Point& query, const Vector& normal, double min_cosine,
                                                    double search_radius) const;

    /// The faces that the segment intersects, in unspecified order. The test is exact for the given coordinates.
    [[nodiscard]] std::vector<Index> met(const Point& from, const Point& to) const;

    /// True if the segment intersects a face for which `ignored` is false. The test is exact for the given coordinates.
    [[nodiscard]] bool meets(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const;

    /// SurfaceSearch::first_exit.
    [[nodiscard]] std::optional<SurfaceHit> first_exit(const Point& origin, const Vector& direction, Index ignored,
                                                       double min_distance) const;

private:
    /// Position relative to the centre of the bounding box, in multiples of its diagonal; the fourth number is used otherwise.
    using Place = Eigen::Array4f;
    /// A node of the tree, the size of one cache line.
    struct alignas(64) Node {
        Place low, high;  ///< corners of the bounding box; the fourth number is 0
        Place cone;       ///< axis of the cone of normals, and cosine of half its opening angle
        float sine;       ///< sine of half the opening angle of the cone of normals
        /// Leaf: index of its first triangle; inner node: index of its second child (the first child is the next node).
        std::uint32_t first;
        std::uint32_t count;  ///< number of triangles of a leaf; 0 for inner nodes
    };
    struct Triangle {
        std::array<Index, 3> corners;
        Index face;
    };
    struct Search;
    struct Ray;
    void build(const FaceOrder& order);
    std::uint32_t build(const FaceOrder& order, std::uint32_t begin, std::uint32_t end, std::uint32_t node);
    void fill(const FaceOrder& order, std::uint32_t begin, std::uint32_t end, Node& leaf);
    void join(std::uint32_t node);
    [[nodiscard]] Eigen::Vector3d place(const Point& p) const;
    template <class Visit>
    void along(const Point& from, const Point& to, const Visit& visit) const;

    const Mesh& mesh_;
    Point middle_;
    double unit_ = 1, scale_ = 1;  ///< diagonal of the bounding box, and its reciprocal
    double area_ = 0;
    std::size_t size_ = 0;
    std::unique_ptr<Node[]> nodes_;
    std::unique_ptr<Triangle[]> triangles_;
};

}  // namespace ostraka
