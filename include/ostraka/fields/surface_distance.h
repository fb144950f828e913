// Signed distances from the places of one surface to another surface.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <vector>

namespace ostraka {

/// A place on a surface and its distance to another surface.
struct PlaceDistance {
    Point place{0, 0, 0};                    ///< the place
    Index face = no_index;                   ///< face of the surface that contains the place
    std::array<double, 3> weights{1, 0, 0};  ///< weights of corners(mesh, face)
    SurfaceHit nearest;                      ///< nearest place of the other surface
    /// Distance of the place from the nearest place, negative on the side of the other surface that its normals point away from.
    /// Positive at places beyond the border, which lie on neither side. NaN for a vertex without faces.
    double distance = 0;
    /// True if the nearest place lies on the border of the other surface and not above it: the surface ends before the place.
    bool beyond = false;
};

/// Signed distances to a surface. The mesh must outlive this object. Queries may run in parallel.
class SignedDistance {
public:
    /// Builds a search tree in O(n log n). Throws Error (input) if all faces are degenerate.
    explicit SignedDistance(const Mesh& mesh);

    /// The nearest place of the surface to `query`. The sign is that of the scalar product with the pseudonormal of the face,
    /// edge or vertex that contains the nearest place (Baerentzen and Aanaes 2005), which is correct for closed surfaces and, for
    /// open surfaces, wherever the nearest place does not lie on the border. `PlaceDistance::face` and `weights` are not set.
    /// Typically O(log n).
    [[nodiscard]] PlaceDistance at(const Point& query) const;

    [[nodiscard]] const Mesh& mesh() const { return search_.mesh(); }
    [[nodiscard]] double diagonal() const { return search_.diagonal(); }  ///< diagonal of the bounding box

private:
    SurfaceSearch search_;
};

/// A place on a surface.
struct SurfacePlace {
    Point place{0, 0, 0};
    Index face = no_index;
    std::array<double, 3> weights{1, 0, 0};  ///< weights of corners(mesh, face)
};

/// `count` places spread evenly over `faces` (all faces if empty), each representing the same area: each face has its share of
/// the places, up to one, inside the face by a low-discrepancy sequence (Roberts 2018). None if the faces have no area. O(n).
/// Throws Error (usage) for the index of a face that the mesh does not have.
std::vector<SurfacePlace> evenly_spread_places(const Mesh& mesh, const std::vector<Index>& faces, std::size_t count);

/// Distances of the places, in their order.
std::vector<PlaceDistance> distances_of(const std::vector<SurfacePlace>& places, const SignedDistance& reference);
/// Distances of the vertices of a mesh, one per vertex; NaN for vertices without faces.
std::vector<PlaceDistance> vertex_distances(const Mesh& mesh, const SignedDistance& reference);

/// The largest distance of a surface from another surface (one-sided Hausdorff distance).
struct FarthestPlace {
    PlaceDistance place;  ///< the place of the largest distance found
    double bound = 0;     ///< no place of the surface is farther away than this length
};

/// Searches the place of `mesh` that is farthest from `reference`. Faces are divided until no part can hold a place that is
/// farther than the one found by more than a thousandth of its distance (and 1e-9 of the diagonal): as the distance from a
/// triangle is a convex function, no place of a part is farther from a triangle of the reference than the farthest corner of the
/// part (compare Tang, Lee and Kim 2009). At most `queries` places are queried; `bound` says what was reached. `vertices`: result
/// of vertex_distances. Throws Error (usage) unless there is one distance per vertex, (input) for a mesh without faces.
FarthestPlace farthest_place(const Mesh& mesh, const std::vector<PlaceDistance>& vertices, const SignedDistance& reference,
                             std::size_t queries = 200000);

/// Statistics of the distances of evenly spread places.
struct DistanceSummary {
    std::size_t places = 0;             ///< number of places
    std::size_t beyond = 0;             ///< number of places beyond the border of the other surface
    double mean = 0, deviation = 0;     ///< of the signed distances of places that are not beyond the border
    double mean_absolute = 0, rms = 0;  ///< of all places
    double lowest = 0, highest = 0;     ///< smallest and largest signed distance
    double raised = 0, lowered = 0;     ///< mean over all places of the positive distances, and of the negative ones as positive
};
/// Shares of the quantiles of the absolute distance in `distance_quantiles`.
inline constexpr std::array<double, 4> distance_quantiles{0.5, 0.9, 0.95, 0.99};

/// Statistics of the distances; `keep_beyond`: false leaves out places beyond the border. Throws Error (input), naming `where`,
/// if no place is left.
DistanceSummary summary_of(const std::vector<PlaceDistance>& places, bool keep_beyond, const std::string& where);
/// For each share: the place with the smallest absolute distance that this share of the places does not exceed. `keep_beyond` and
/// errors as for summary_of.
std::vector<PlaceDistance> quantile_places(const std::vector<PlaceDistance>& places, const std::vector<double>& shares,
                                           bool keep_beyond, const std::string& where);

/// Shares of the places in a tolerance band; they add up to 1.
struct ToleranceShares {
    double within = 0;            ///< absolute distance at most the tolerance
    double above = 0, below = 0;  ///< signed distance above the tolerance, below its negative
    double beyond = 0;            ///< beyond the border and farther than the tolerance
};
ToleranceShares tolerance_shares(const std::vector<PlaceDistance>& places, double tolerance, bool keep_beyond);

}  // namespace ostraka
