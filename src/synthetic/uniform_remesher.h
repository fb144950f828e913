// Remeshes the irregular triangles of a marched surface into a given number of uniform triangles, without leaving the surface.
#pragma once

#include "synthetic/lattice.h"

namespace ostraka::shapes {

/// A closed triangle mesh with opposite halfedges: halfedge 3 f + k goes from corner k of face f to corner k + 1.
class HalfedgeTable {
public:
    explicit HalfedgeTable(const Triangles& mesh);

    static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
    [[nodiscard]] Index opposite(Index h) const { return opposite_[h]; }
    [[nodiscard]] Index origin(Index h) const { return origin_[h]; }
    [[nodiscard]] Index target(Index h) const { return origin_[next(h)]; }
    [[nodiscard]] Index outgoing(Index v) const { return outgoing_[v]; }  ///< no_index if the vertex was removed
    [[nodiscard]] bool alive(Index h) const { return origin_[h] != no_index; }
    [[nodiscard]] std::size_t halfedges() const { return origin_.size(); }
    [[nodiscard]] std::size_t vertices() const { return outgoing_.size(); }
    [[nodiscard]] std::size_t living_vertices() const { return living_vertices_; }

    /// Calls visit(halfedge) for the halfedges that leave `v`, clockwise.
    template <class Visit>
    void around(Index v, Visit&& visit) const {
        const Index first = outgoing_[v];
        Index h = first;
        do {
            visit(h);
            h = next(opposite_[h]);
        } while (h != first);
    }

    /// Whether the surface stays a manifold when the edge is collapsed to its origin.
    [[nodiscard]] bool can_collapse(Index h) const;
    /// Merges the target into the origin.
    void collapse(Index h);
    /// Whether the two corners opposite to the edge are not yet connected by an edge.
    [[nodiscard]] bool can_flip(Index h) const;
    /// Replaces the edge by the edge between the opposite corners.
    void flip(Index h);

private:
    void glue(Index a, Index b) { opposite_[a] = b, opposite_[b] = a; }
    std::vector<Index> origin_, opposite_, outgoing_;
    std::size_t living_vertices_;
};

/// Collapses short edges until `vertices` are left, flips edges towards Delaunay triangles and moves vertices along the surface
/// towards the centres of their neighbours. No triangle ever turns against the surface normal, so the mesh stays as embedded as
/// before. Returns a mesh with `vertices` points, or more if the shape allows no further collapse.
Triangles remesh_uniformly(const SyntheticObject& object, Triangles mesh, std::size_t vertices);

}  // namespace ostraka::shapes
