// Closest-point and segment queries on a mesh, with a tree of bounding boxes and normal cones.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace ostraka {

/// A point on the surface found by a query.
struct SurfaceHit {
    Index face = no_index;                       ///< index of the face
    Point point{0, 0, 0};                        ///< position of the hit
    std::array<double, 3> barycentric{1, 0, 0};  ///< weights of corners(mesh, face)
    double distance = 0;  ///< distance from the query point; for line_hits signed, positive along the direction
};

/// A search tree over the faces of a mesh. The mesh must outlive the tree and have no garbage. Queries may run in parallel.
/// Degenerate faces are ignored. A query typically costs O(log n).
class SurfaceSearch {
public:
    /// Builds the tree in O(n) on all threads; results do not depend on the number of threads. Throws Error (input) if all
    /// faces are degenerate.
    explicit SurfaceSearch(const Mesh& mesh);
    ~SurfaceSearch();
    SurfaceSearch(SurfaceSearch&&) noexcept;

    [[nodiscard]] const Mesh& mesh() const;
    /// Edge length of an equilateral triangle with the mean face area.
    [[nodiscard]] double typical_edge() const;
    [[nodiscard]] double diagonal() const;  ///< diagonal of the bounding box of the mesh
    /// Unit normal of a face.
    [[nodiscard]] Vector normal(Index face) const;

    /// All faces that intersect the segment from origin - max_distance * direction to origin + max_distance * direction, the hit
    /// closest to `origin` first (ties by face index). `direction` is a unit vector. The set of faces is exact for the rounded
    /// end points of the segment.
    [[nodiscard]] std::vector<SurfaceHit> line_hits(const Point& origin, const Vector& direction, double max_distance) const;

    /// The first face, other than `ignored`, through which a ray leaves the solid: the scalar product of its normal and
    /// `direction`, a unit vector, is positive, and its distance is above `min_distance`. Ties go to the lowest face index. Rays
    /// end at 1.01 times the diagonal of the mesh's bounding box. Which faces the ray crosses is exact for the rounded end point.
    /// Nodes of the tree are visited in the order in which the ray reaches them (Wald, Boulos and Shirley 2007).
    [[nodiscard]] std::optional<SurfaceHit> first_exit(const Point& origin, const Vector& direction, Index ignored,
                                                       double min_distance) const;

    /// True if the segment intersects a face for which `ignored` is false. The test is exact for the given coordinates.
    [[nodiscard]] bool blocked(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const;

    /// The point of the surface closest to `query`.
    [[nodiscard]] SurfaceHit closest(const Point& query) const;

    /// The point closest to `query` within `search_radius` on a face whose unit normal has a scalar product of at least
    /// `min_cosine` with `normal`; nullopt if there is none.
    [[nodiscard]] std::optional<SurfaceHit> closest_compatible(const Point& query, const Vector& normal, double min_cosine,
                                                               double search_radius) const;

    /// True if `query` lies inside the closed surface: at least three of four rays from the point intersect the surface an odd
    /// number of times. The answer tolerates small folds and holes of the surface.
    [[nodiscard]] bool inside(const Point& query) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

/// Edge length of an equilateral triangle with the mean area of `faces` faces.
double typical_edge(double area, std::size_t faces);

/// Barycentric coordinates of the point of triangle abc closest to p (Ericson 2005, section 5.1.5).
std::array<double, 3> nearest_barycentric(const Point& a, const Point& b, const Point& c, const Point& p);

/// The point with the given barycentric coordinates in triangle abc.
Point point_at(const Point& a, const Point& b, const Point& c, const std::array<double, 3>& barycentric);
/// The point with the given barycentric coordinates in a face.
Point point_at(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric);

}  // namespace ostraka
