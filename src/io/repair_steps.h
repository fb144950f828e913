// The soup under repair and the repair steps. Private to the module.
#pragma once

#include "io/soup_edges.h"
#include "ostraka/io/repair.h"

namespace ostraka::detail {

/// A triangle soup under repair that tracks the old elements from which its elements come.
struct RepairSoup {
    TriangleSoup soup;
    /// Per vertex: the identical old vertex (no_index: new); the old vertex that provides the attributes.
    std::vector<Index> vertex_source, vertex_like;
    /// Per triangle: the identical old triangle (no_index: new); the old triangle that provides the attributes.
    std::vector<Index> face_source, face_like;
    /// Per triangle corner: 3 * old triangle + old corner that provides the texture coordinates.
    std::vector<std::array<Index, 3>> corner_like;
    std::vector<std::uint8_t> flipped;  ///< per triangle: 1 if its orientation was reversed
    std::vector<std::uint8_t> touched;  ///< per vertex: 1 if it belonged to a triangle that was cut out
    std::vector<Index> merged_into;     ///< for each old vertex: the old vertex into which it was merged, or itself
    std::vector<Index> duplicate_of;    ///< for each old triangle: the old triangle that was kept instead, or itself

    explicit RepairSoup(const TriangleSoup& original);
    [[nodiscard]] Index triangle_count() const { return static_cast<Index>(soup.triangles.size()); }
    /// Appends a vertex and returns its index; see `vertex_source` and `vertex_like`.
    Index add_vertex(const std::array<double, 3>& place, Index source, Index like, bool is_touched);
    void add_triangle(const std::array<Index, 3>& corners, Index source, Index like, const std::array<Index, 3>& corners_like,
                      bool is_flipped);
    void flip(Index triangle);  ///< reverses the orientation
    /// Removes the triangles whose flag is 0.
    void keep_triangles(const std::vector<std::uint8_t>& keep);
    /// Drops vertices without triangles; with `keep_original`, one copy of each old vertex is kept. Returns the number of dropped
    /// vertices.
    std::size_t drop_isolated(bool keep_original);
};

using Counts = std::vector<std::pair<std::string, std::size_t>>;  ///< kind of change -> number of changes

/// For each halfedge of a manifold soup: its opposite halfedge; no_index on the border.
std::vector<Index> opposite_halfedges(const TriangleSoup& soup);

/// Distances within which points are merged.
struct MergeDistances {
    double distance;  ///< points closer than this distance are merged; in the mesh's unit
    double gap;       ///< maximum width of cracks, as a fraction of the shortest edge at a point
};
/// Merges points on open borders. `crack` receives the width of cracks along the edges; 0 if there are none.
Counts merge_points(RepairSoup& work, const MergeDistances& limits, double& crack);
/// Width of cracks in the surface if nine in ten border vertices have a mate closer than half of the shortest edge at the vertex;
/// else 0.
double crack_width(const TriangleSoup& soup);
/// Inserts border vertices into triangle edges on which the vertices lie within the tolerance (T-junctions).
Counts sew_junctions(RepairSoup& work, double tolerance);
Counts drop_invalid_triangles(RepairSoup& work);  ///< triangles with a repeated corner, and duplicates
Counts orient_patches(RepairSoup& work);          ///< orients triangles consistently across manifold edges
/// Joins triangles at edges in pairs and gives each fan of triangles its own vertex.
Counts separate_nonmanifold(RepairSoup& work);
/// Gives each fan of triangles its own vertex, without new triangles: triangles that cannot be joined to others in this way get
/// three vertices of their own. Vertices and triangles keep their indices; copies of vertices are appended. Returns their number.
std::size_t cut_apart(RepairSoup& work);
/// Drops components with a smaller fraction of the area, or all but the largest component.
Counts drop_components(RepairSoup& work, bool only_largest, double smallest_share);
Counts flip_degenerate(RepairSoup& work);  ///< removes degenerate triangles by edge flips
Counts orient_outwards(RepairSoup& work);  ///< orients closed components outwards, except cavities

/// Which holes are filled.
struct HoleLimits {
    std::size_t edges;  ///< maximum number of border edges
    double share;       ///< maximum width of a hole, as a fraction of the component's diagonal
    bool only_touched;  ///< true: fill only holes created by cutting out triangles
};
Counts fill_holes(RepairSoup& work, const HoleLimits& limits);

Counts remove_self_intersections(RepairSoup& work, std::vector<std::string>& notes);

}  // namespace ostraka::detail
