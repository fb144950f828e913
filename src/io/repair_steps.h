// The soup under repair and the steps that change it. Private to the module.
#pragma once

#include "ostraka/io/repair.h"
#include "soup_edges.h"

namespace ostraka::detail {

/// A soup that remembers where its elements come from. "Source" is the old element it is (for the maps), no_index if it was
/// made; "like" is the old element whose colour, label and texture it takes.
struct Worksoup {
    TriangleSoup soup;
    std::vector<Index> vertex_source, vertex_like;
    std::vector<Index> face_source, face_like;
    std::vector<std::array<Index, 3>> corner_like;  ///< 3 * old triangle + old corner
    std::vector<std::uint8_t> flipped;              ///< per triangle: turned over since it was read
    std::vector<std::uint8_t> touched;              ///< per vertex: at a place where triangles were cut out
    std::vector<Index> merged_into;                 ///< old vertex -> old vertex it was merged into (or itself)
    std::vector<Index> duplicate_of;                ///< old triangle -> old triangle kept in its stead (or itself)

    explicit Worksoup(const TriangleSoup& original);
    [[nodiscard]] Index triangle_count() const { return static_cast<Index>(soup.triangles.size()); }
    Index add_vertex(const std::array<double, 3>& place, Index source, Index like, bool is_touched);
    void add_triangle(const std::array<Index, 3>& corners, Index source, Index like, const std::array<Index, 3>& corners_like,
                      bool is_flipped);
    void flip(Index triangle);
    void keep_triangles(const std::vector<std::uint8_t>& keep);
    /// Drops vertices without a triangle but those with `keep`; returns how many.
    std::size_t drop_isolated(bool keep_original);
};

using Counts = std::vector<std::pair<std::string, std::size_t>>;

/// Opposite of each halfedge of a manifold soup, no_index on the border.
std::vector<Index> pair_manifold(const TriangleSoup& soup);

struct MergeDistances {
    double distance;  ///< in the mesh's unit
    double gap;       ///< share of the shortest edge at a point that cracks are narrower than
};
/// `crack`: how wide cracks along the edges are, 0 where there are none.
Counts merge_points(Worksoup& work, const MergeDistances& limits, double& crack);
/// How wide cracks are where nine in ten vertices of the border have a mate nearer than half of their shortest edge; else 0.
double crack_width(const TriangleSoup& soup);
/// Border vertices that lie on a side of a triangle beyond, to the tolerance, are inserted there (T-junctions).
Counts sew_junctions(Worksoup& work, double tolerance);
Counts drop_bad_triangles(Worksoup& work);
Counts orient_patches(Worksoup& work);
/// Joins triangles at edges, two by two, and gives each fan of triangles a vertex of its own.
Counts take_apart(Worksoup& work);
Counts drop_components(Worksoup& work, bool only_largest, double smallest_share);
Counts flip_degenerate(Worksoup& work);
Counts turn_outwards(Worksoup& work);

struct HoleLimits {
    std::size_t edges;
    double share;       ///< widest, as a share of the component's diagonal
    bool only_touched;  ///< only holes made by cutting out
};
Counts fill_holes(Worksoup& work, const HoleLimits& limits);

Counts remove_self_intersections(Worksoup& work, std::vector<std::string>& notes);

}  // namespace ostraka::detail
