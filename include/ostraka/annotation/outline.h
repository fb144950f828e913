// Outlines of regions: extraction (thesis, Algorithm 4, with its erratum) and filling (section 2.4.1).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

/// A closed path of vertices, without repeating the first; the interior lies to the left of each edge.
using Outline = std::vector<Index>;

/// The outlines of a set of faces, given as one flag per face. Where an outline touches itself at a vertex, it is split so that
/// the interior stays on the left and the loops stay separate (each fan of selected faces around a vertex is passed once).
/// Border edges of an open mesh belong to the outline. Loops start at their smallest vertex and are ordered by their first
/// halfedge. Linear in the number of selected faces, except for one pass over the flags.
std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<bool>& selected);
std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<Index>& faces);

/// A path of vertices along an outline: all of it, or a stretch from border to border of the mesh.
struct OutlinePath {
    std::vector<Index> vertices;
    bool closed = false;  ///< without repeating the first vertex
};
/// The outlines of faces without the edges on the border of the mesh, which split them into open paths.
std::vector<OutlinePath> outline_paths(const Mesh& mesh, const std::vector<Index>& faces);

/// The walk without repeats and without "a, b, a"; if `closed`, also across the end. A closed path of fewer than three vertices
/// becomes empty.
std::vector<Index> prune_spikes(const std::vector<Index>& walk, bool closed);

/// The interior of a set of outlines.
struct Filling {
    std::vector<bool> selected;  ///< one flag per face
    std::size_t conflicts = 0;   ///< faces left of one outline edge and right of another: the outlines intersect
};

/// Grows the region from the faces left of the outline edges, without crossing an outline edge. Edges that are traversed in
/// both directions are not boundaries and are ignored. Throws Error (input) with the outline and the edge if an index is out of
/// range, an edge does not exist or an outline has fewer than three vertices.
Filling fill_outlines(const Mesh& mesh, const std::vector<Outline>& outlines);

/// The same for directed edges that need not form closed paths: they may end on the border of the mesh.
Filling fill_edges(const Mesh& mesh, const std::vector<Halfedge>& edges);

/// Selects faces by winding number: crossing an edge from right to left adds the net number of its traversals in `edges`. Also
/// defined for intersecting outlines: among the sets "winding number at least k", including the empty set, returns the one
/// whose area is nearest to `expected_area`; this is done per connected component. Returns nullopt if the numbers contradict
/// each other (the edges are not a boundary). Linear in the size of the mesh.
std::optional<std::vector<bool>> fill_by_winding(const Mesh& mesh, const std::vector<Halfedge>& edges, double expected_area);

/// Area and perimeter of a region.
struct RegionMeasures {
    double area = 0;       ///< sum of the faces' areas
    double perimeter = 0;  ///< sum of the lengths of the outline edges
    [[nodiscard]] double circularity() const {
        return area > 0 ? perimeter * perimeter / area : 0;
    }  ///< P^2 / A, 4 pi for a disc
};
RegionMeasures measure_region(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka
