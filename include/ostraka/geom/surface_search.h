// Nearest-point and segment queries on a mesh, with a tree of bounding boxes and normal cones.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace ostraka {

/// A point on the surface found by a query.
struct SurfaceHit {
    Index face = no_index;
    Point point{0, 0, 0};
    std::array<double, 3> barycentric{1, 0, 0};  ///< weights of corners(mesh, face)
    double distance = 0;                         ///< distance from the query point; signed along the direction for line hits
};

/// A search tree over the faces of a mesh, which must outlive it and have no garbage. Queries may run in parallel. Degenerate
/// faces are ignored. A query typically costs O(log n).
class SurfaceSearch {
public:
    /// Builds the tree in O(n) on all threads; results do not depend on the number of threads. Throws Error (input) if all
    /// faces are degenerate.
    explicit SurfaceSearch(const Mesh& mesh);
    ~SurfaceSearch();
    SurfaceSearch(SurfaceSearch&&) noexcept;

    [[nodiscard]] const Mesh& mesh() const;
    /// Edge length of an equilateral triangle with the mean face area, and the diagonal of the bounding box of the mesh.
    [[nodiscard]] double typical_edge() const;
    [[nodiscard]] double diagonal() const;
    /// Unit normal of a face.
    [[nodiscard]] Vector normal(Index face) const;

    /// All faces that intersect the segment from origin - max_distance * direction to origin + max_distance * direction,
    /// nearest first (ties by face index). `direction` is a unit vector. The set of faces is exact for the rounded end points
    /// of the segment.
    [[nodiscard]] std::vector<SurfaceHit> line_hits(const Point& origin, const Vector& direction, double max_distance) const;

    /// True if the segment intersects a face that `ignored` does not accept. Exact for the given coordinates.
    [[nodiscard]] bool blocked(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const;

    /// The nearest point of the surface; needs at least one face.
    [[nodiscard]] SurfaceHit closest(const Point& query) const;

    /// The nearest point within `search_radius` on a face whose unit normal has a scalar product of at least `min_cosine` with
    /// `normal`.
    [[nodiscard]] std::optional<SurfaceHit> closest_compatible(const Point& query, const Vector& normal, double min_cosine,
                                                               double search_radius) const;

    /// True if at least three of four rays intersect the surface an odd number of times: the point lies inside a closed
    /// surface, even if the surface has small folds or holes.
    [[nodiscard]] bool inside(const Point& query) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

/// Edge length of an equilateral triangle with the mean area of `faces` faces.
double typical_edge(double area, std::size_t faces);

/// Barycentric coordinates of the point of triangle abc nearest to p (Ericson 2005, section 5.1.5).
std::array<double, 3> nearest_barycentric(const Point& a, const Point& b, const Point& c, const Point& p);

/// The point with the given barycentric coordinates in triangle abc or in a face.
Point point_at(const Point& a, const Point& b, const Point& c, const std::array<double, 3>& barycentric);
Point point_at(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric);

}  // namespace ostraka
