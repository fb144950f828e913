// Remeshes the irregular triangles of a marched surface to a given number of uniform triangles, without leaving the surface.
#pragma once

#include "synthetic/lattice.h"

namespace ostraka::shapes {

/// A closed triangle mesh with opposite halfedges: halfedge 3 f + k goes from corner k to corner k + 1 of face f.
class HalfedgeTable {
public:
    explicit HalfedgeTable(const Triangles& mesh);

    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }       ///< next halfedge of the face
    static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }   ///< previous halfedge of the face
    [[nodiscard]] Index opposite(Index h) const { return opposite_[h]; }    ///< opposite halfedge
    [[nodiscard]] Index origin(Index h) const { return origin_[h]; }        ///< vertex at which the halfedge starts
    [[nodiscard]] Index target(Index h) const { return origin_[next(h)]; }  ///< vertex at which the halfedge ends
    /// A halfedge that leaves the vertex; no_index: the vertex was removed.
    [[nodiscard]] Index outgoing(Index v) const { return outgoing_[v]; }
    [[nodiscard]] bool alive(Index h) const { return origin_[h] != no_index; }  ///< false: the halfedge was removed
    [[nodiscard]] std::size_t halfedges() const { return origin_.size(); }      ///< number of halfedges, including removed ones
    [[nodiscard]] std::size_t vertices() const { return outgoing_.size(); }     ///< number of vertices, including removed ones
    [[nodiscard]] std::size_t living_vertices() const { return living_vertices_; }  ///< number of vertices that were not removed

    /// Calls visit(halfedge) for each halfedge that leaves the vertex `v`, clockwise.
    template <class Visit>
    void around(Index v, Visit&& visit) const {
        const Index first = outgoing_[v];
        Index h = first;
        do {
            visit(h);
            h = next(opposite_[h]);
        } while (h != first);
    }

    /// Whether the surface stays a manifold when the edge of `h` is collapsed to its origin.
    [[nodiscard]] bool can_collapse(Index h) const;
    /// Merges the target of `h` into its origin.
    void collapse(Index h);
    /// Whether the two corners opposite to the edge of `h` are not yet connected by an edge.
    [[nodiscard]] bool can_flip(Index h) const;
    /// Replaces the edge of `h` by the edge between the two opposite corners.
    void flip(Index h);

private:
    void glue(Index a, Index b) { opposite_[a] = b, opposite_[b] = a; }  ///< makes the halfedges opposite to each other
    /// For each halfedge, its origin and opposite; for each vertex, a halfedge that leaves it.
    std::vector<Index> origin_, opposite_, outgoing_;
    std::size_t living_vertices_;
};

/// Collapses short edges until `vertices` vertices are left, flips edges towards Delaunay triangles and moves vertices along the
/// surface towards the centres of their neighbours. No triangle is ever reversed relative to the surface normal, so that no new
/// self-intersections arise from reversed triangles. Returns a mesh with `vertices` points, or more if the shape allows no
/// further collapse.
Triangles remesh_uniformly(const SyntheticObject& object, Triangles mesh, std::size_t vertices);

}  // namespace ostraka::shapes
