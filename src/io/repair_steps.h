// The soup under repair and the repair steps. Private to the module.
#pragma once

#include "io/soup_edges.h"
#include "ostraka/io/repair.h"

namespace ostraka::detail {

/// A soup that tracks the origin of its elements. "Source" is the identical old element (for the maps), no_index for new
/// elements; "like" is the old element that provides colour, label and texture coordinates.
struct RepairSoup {
    TriangleSoup soup;
    std::vector<Index> vertex_source, vertex_like;
    std::vector<Index> face_source, face_like;
    std::vector<std::array<Index, 3>> corner_like;  ///< 3 * old triangle + old corner
    std::vector<std::uint8_t> flipped;              ///< per triangle: orientation reversed since reading
    std::vector<std::uint8_t> touched;              ///< per vertex: belongs to a triangle that was cut out
    std::vector<Index> merged_into;                 ///< old vertex -> old vertex it was merged into (or itself)
    std::vector<Index> duplicate_of;                ///< old triangle -> old triangle kept instead (or itself)

    explicit RepairSoup(const TriangleSoup& original);
    [[nodiscard]] Index triangle_count() const { return static_cast<Index>(soup.triangles.size()); }
    Index add_vertex(const std::array<double, 3>& place, Index source, Index like, bool is_touched);
    void add_triangle(const std::array<Index, 3>& corners, Index source, Index like, const std::array<Index, 3>& corners_like,
                      bool is_flipped);
    void flip(Index triangle);
    void keep_triangles(const std::vector<std::uint8_t>& keep);
    /// Drops vertices without triangles; with `keep_original`, one copy of each original vertex is kept. Returns the number of
    /// dropped vertices.
    std::size_t drop_isolated(bool keep_original);
};

using Counts = std::vector<std::pair<std::string, std::size_t>>;

/// Opposite halfedge of each halfedge of a manifold soup; no_index on the border.
std::vector<Index> pair_manifold(const TriangleSoup& soup);

struct MergeDistances {
    double distance;  ///< in the mesh's unit
    double gap;       ///< maximum width of cracks, as a fraction of the shortest edge at a point
};
/// `crack`: receives the width of cracks along the edges, 0 if there are none.
Counts merge_points(RepairSoup& work, const MergeDistances& limits, double& crack);
/// Width of cracks if nine in ten border vertices have a mate closer than half of their shortest edge; else 0.
double crack_width(const TriangleSoup& soup);
/// Inserts border vertices into triangle edges on which they lie within the tolerance (T-junctions).
Counts sew_junctions(RepairSoup& work, double tolerance);
Counts drop_invalid_triangles(RepairSoup& work);
Counts orient_patches(RepairSoup& work);
/// Joins triangles at edges in pairs and gives each fan of triangles its own vertex.
Counts separate_nonmanifold(RepairSoup& work);
Counts drop_components(RepairSoup& work, bool only_largest, double smallest_share);
Counts flip_degenerate(RepairSoup& work);
Counts orient_outwards(RepairSoup& work);

struct HoleLimits {
    std::size_t edges;
    double share;       ///< maximum width, as a fraction of the component's diagonal
    bool only_touched;  ///< only holes created by cutting out triangles
};
Counts fill_holes(RepairSoup& work, const HoleLimits& limits);

Counts remove_self_intersections(RepairSoup& work, std::vector<std::string>& notes);

}  // namespace ostraka::detail
