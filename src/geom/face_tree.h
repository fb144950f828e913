// Nearest faces of a mesh, among those whose normals agree, and the faces that a segment meets.
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

/// A hierarchy of boxes, each with a cone around the normals in it: where no normal can agree, a search for the nearest face goes
/// no further, so that it costs no more where the nearest faces are turned away. About 50 bytes a face. Building costs O(n), on
/// all threads; the tree does not depend on their number.
class FaceTree {
public:
    /// Over the faces that have an area. The mesh outlives the tree, and has no garbage.
    explicit FaceTree(const Mesh& mesh);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    /// Faces that have an area; the area of all; the diagonal of the mesh's box.
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] double area() const { return area_; }
    [[nodiscard]] double diagonal() const { return unit_; }

    /// The nearest place within `search_radius` on a face whose unit normal has a scalar product of at least `min_cosine` with
    /// `normal` (-1: on any face); of equally near ones the face of the lowest index.
    [[nodiscard]] std::optional<SurfaceHit> closest(const Point& query, const Vector& normal, double min_cosine,
                                                    double search_radius) const;

    /// The faces that the segment meets, in no order that means anything. Exact for the coordinates as given.
    [[nodiscard]] std::vector<Index> met(const Point& from, const Point& to) const;

    /// Whether the segment meets a face that `ignored` does not accept. Exact as well.
    [[nodiscard]] bool meets(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const;

private:
    using Place = Eigen::Array4f;  ///< about the mesh's middle, in diagonals of its box; the last number is something else
    /// One line of a processor's cache.
    struct alignas(64) Node {
        Place low, high;      ///< and 0
        Place cone;           ///< axis of the normals' cone, and the cosine of half its opening
        float sine;           ///< of half the cone's opening
        std::uint32_t first;  ///< triangle of a leaf; the second child of others, whose first is the next node
        std::uint32_t count;  ///< triangles of a leaf; 0 for others
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
    double unit_ = 1, scale_ = 1;  ///< the diagonal, and one by it
    double area_ = 0;
    std::size_t size_ = 0;
    std::unique_ptr<Node[]> nodes_;
    std::unique_ptr<Triangle[]> triangles_;
};

}  // namespace ostraka
