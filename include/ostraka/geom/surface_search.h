// Nearest points on a mesh and what segments meet, from one tree of boxes with normal cones.
#pragma once

#include "ostraka/core/mesh.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace ostraka {

/// A place on the surface found by a query.
struct SurfaceHit {
    Index face = no_index;
    Point point{0, 0, 0};
    std::array<double, 3> barycentric{1, 0, 0};  ///< weights of corners(mesh, face)
    double distance = 0;                         ///< to the query point; signed along the direction for line hits
};

/// A search tree over the faces of a mesh, which must outlive it and have no garbage. Queries may run in parallel. Faces without
/// area are left out. A query costs O(log n) typically.
class SurfaceSearch {
public:
    /// Builds all that queries need, in O(n) on all threads; answers do not depend on their number. Throws Error (input) if no
    /// face has an area.
    explicit SurfaceSearch(const Mesh& mesh);
    ~SurfaceSearch();
    SurfaceSearch(SurfaceSearch&&) noexcept;

    [[nodiscard]] const Mesh& mesh() const;
    /// Edge length of an equilateral triangle with the faces' mean area, and the diagonal of the mesh's box.
    [[nodiscard]] double typical_edge() const;
    [[nodiscard]] double diagonal() const;
    /// Unit normal of a face.
    [[nodiscard]] Vector normal(Index face) const;

    /// All faces met by the segment from origin - max_distance * direction to origin + max_distance * direction, nearest first
    /// (ties by face index). `direction` is a unit vector. Which faces are met is exact for the segment's ends as rounded.
    [[nodiscard]] std::vector<SurfaceHit> line_hits(const Point& origin, const Vector& direction, double max_distance) const;

    /// True if the segment meets a face other than those that `ignored` accepts. Exact for the coordinates as given.
    [[nodiscard]] bool blocked(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const;

    /// The nearest point of the surface; needs at least one face.
    [[nodiscard]] SurfaceHit closest(const Point& query) const;

    /// The nearest point within `search_radius` on a face whose unit normal has a scalar product of at least `min_cosine` with
    /// `normal`.
    [[nodiscard]] std::optional<SurfaceHit> closest_compatible(const Point& query, const Vector& normal, double min_cosine,
                                                               double search_radius) const;

    /// True if at least three of four rays leave the surface an odd number of times: inside a closed surface, even if it has
    /// small folds or holes.
    [[nodiscard]] bool inside(const Point& query) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

/// Barycentric coordinates of the point of triangle abc nearest to p (Ericson 2005, section 5.1.5), clamped to it.
std::array<double, 3> nearest_barycentric(const Point& a, const Point& b, const Point& c, const Point& p);

/// The point with the given barycentric coordinates, of triangle abc and of a face.
Point point_at(const Point& a, const Point& b, const Point& c, const std::array<double, 3>& barycentric);
Point point_at(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric);

}  // namespace ostraka
