// Edges of a triangle soup, without assumptions about its topology. Private to the module.
#pragma once

#include "ostraka/mesh/disjoint_sets.h"
#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka::detail {

inline Index next_halfedge(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline Index previous_halfedge(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// The undirected edges of a triangle soup, each with its halfedges. Halfedge 3 t + k runs from corner k to corner k + 1 of
/// triangle t. Triangles with a repeated vertex are ignored.
struct SoupEdges {
    std::vector<Index> halfedges;  ///< indices of halfedges grouped by edge; within an edge sorted by triangle
    std::vector<Index> begin;      ///< edge e has the entries [begin[e], begin[e + 1]) of `halfedges`
    [[nodiscard]] std::size_t count() const { return begin.size() - 1; }  ///< number of edges
    /// Number of halfedges of an edge.
    [[nodiscard]] Index valence(std::size_t edge) const { return begin[edge + 1] - begin[edge]; }
    /// First halfedge of an edge.
    [[nodiscard]] const Index* first(std::size_t edge) const { return halfedges.data() + begin[edge]; }
};

/// Vertex at which a halfedge starts.
inline Index origin(const TriangleSoup& soup, Index h) { return soup.triangles[h / 3][h % 3]; }
/// Vertex at which a halfedge ends.
inline Index target(const TriangleSoup& soup, Index h) { return soup.triangles[h / 3][(h + 1) % 3]; }
/// Vertex opposite to a halfedge in its triangle.
inline Index apex(const TriangleSoup& soup, Index h) { return soup.triangles[h / 3][(h + 2) % 3]; }
/// True if a triangle has a repeated vertex.
inline bool repeats_corner(const std::array<Index, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Sets of vertices that are connected by triangles.
DisjointSets joined_vertices(const TriangleSoup& soup);

/// Groups the halfedges of a soup by edge. Time: linear, plus the sorting of about six halfedges per vertex.
SoupEdges group_edges(const TriangleSoup& soup);

/// For each point, the smallest index of a point with the same position (negative zero equals zero). Expected time: linear.
std::vector<Index> same_place(const std::vector<std::array<double, 3>>& points);

/// Checks a triangle soup: throws Error (input) if a vertex index is out of range, if a coordinate is not finite or beyond 1e100,
/// or if there are more elements than an Index can number.
void check_soup(const TriangleSoup& soup);

/// Sets of triangle corners (3 t + k) at one vertex whose triangles are connected by edges at the vertex, whatever the valence of
/// these edges: one set per fan of triangles.
DisjointSets fans_of_corners(const TriangleSoup& soup, const SoupEdges& edges);

}  // namespace ostraka::detail
